#include "compare/formula.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"

const char *
spec_formula_alpha(const struct spec_arithmetic_setup *setup)
{
	return setup->operation == SPEC_ARITHMETIC_OVER && setup->alpha ? setup->alpha
									: "A";
}

static void
write_chain(FILE *to, const char *sign, size_t images)
{
	for (size_t i = 1; i <= images; i++)
		fprintf(to, "%simage%zu", i > 1 ? sign : "", i);
}

static void
write_mean(FILE *to, const double *weight, size_t images)
{
	double sum = 0;

	fputc('(', to);
	for (size_t i = 0; i < images; i++) {
		sum += weight ? weight[i] : 1;
		fprintf(to, "%simage%zu", i > 0 ? "+" : "", i + 1);
		if (weight)
			fprintf(to, "*%.17g", weight[i]);
	}
	fprintf(to, ")/%.17g", sum);
}

/* "image2.("NAME")" */
static void
write_channel(FILE *to, size_t image, const char *name)
{
	fprintf(to, "image%zu.(\"", image);
	for (const char *byte = name; *byte; byte++)
		fprintf(to, "%s%c", *byte == '"' || *byte == '\\' ? "\\" : "", *byte);
	fputs("\")", to);
}

static void
write_over(FILE *to, const char *alpha, size_t images)
{
	fprintf(to, "r=image%zu;", images);
	for (size_t i = images - 1; i > 0; i--) {
		fprintf(to, "r=image%zu+mix(r,0,", i);
		write_channel(to, i, alpha);
		fputs(");", to);
	}
	fputs("r", to);
}

static void
write_lerp(FILE *to, const struct spec_matte *mask, size_t images)
{
	fputs("mix(image1,image2,", to);
	write_channel(to, mask->path ? images + 1 : 1, mask->channel);
	if (mask->equals)
		fprintf(to, "==%lu", (unsigned long)mask->number);
	fputs(")", to);
}

static void
write_formula(FILE *to, const struct spec_arithmetic_setup *setup, const double *weight,
	size_t images)
{
	switch (setup->operation) {
	case SPEC_ARITHMETIC_ADD:
		write_chain(to, "+", images);
		break;
	case SPEC_ARITHMETIC_SUBTRACT:
		write_chain(to, "-", images);
		break;
	case SPEC_ARITHMETIC_MULTIPLY:
		write_chain(to, "*", images);
		break;
	case SPEC_ARITHMETIC_DIVIDE:
		write_chain(to, "/", images);
		break;
	case SPEC_ARITHMETIC_MIN:
	case SPEC_ARITHMETIC_MAX:
		fputs(setup->operation == SPEC_ARITHMETIC_MIN ? "min(" : "max(", to);
		write_chain(to, ",", images);
		fputs(")", to);
		break;
	case SPEC_ARITHMETIC_MEAN:
	case SPEC_ARITHMETIC_MERGE:
		write_mean(to, weight, images);
		break;
	case SPEC_ARITHMETIC_OVER:
		write_over(to, spec_formula_alpha(setup), images);
		break;
	case SPEC_ARITHMETIC_LERP:
		write_lerp(to, setup->mask, images);
		break;
	case SPEC_ARITHMETIC_EXPRESSION:
		fputs(setup->expression, to);
		break;
	}
}

/* Takes over what was written. */
static enum spec_status
close_text(struct spec_text *written, char **text, struct spec_error *error)
{
	enum spec_status status = spec_text_close(written, error);

	*text = NULL;
	if (status == SPEC_OK) {
		*text = spec_memory_text(written->bytes, written->size, error);
		status = *text ? SPEC_OK : SPEC_ENOMEM;
	}
	spec_text_free(written);
	return status;
}

enum spec_status
spec_formula_write(const struct spec_arithmetic_setup *setup, const double *weight,
	size_t images, char **text, struct spec_error *error)
{
	struct spec_text written;
	enum spec_status status = spec_text_open(&written, error);

	*text = NULL;
	if (status != SPEC_OK)
		return status;
	write_formula(written.stream, setup, weight, images);
	return close_text(&written, text, error);
}

static void
write_weighted_variances(FILE *to, const double *weight, size_t images)
{
	double sum = 0;

	for (size_t i = 0; i < images; i++)
		sum += weight ? weight[i] : 1;
	for (size_t i = 0; i < images; i++) {
		double share = (weight ? weight[i] : 1) / sum;

		fprintf(to, "%s%.17g*image%zu", i > 0 ? "+" : "", share * share, i + 1);
	}
}

enum spec_status
spec_formula_variance(const struct spec_arithmetic_setup *setup, const double *weight,
	size_t images, char **text, struct spec_error *error)
{
	int sums = setup->operation == SPEC_ARITHMETIC_ADD ||
		   setup->operation == SPEC_ARITHMETIC_SUBTRACT;
	struct spec_text written;
	enum spec_status status;

	*text = NULL;
	if (!sums && setup->operation != SPEC_ARITHMETIC_MEAN &&
		setup->operation != SPEC_ARITHMETIC_MERGE)
		return SPEC_OK;
	status = spec_text_open(&written, error);
	if (status != SPEC_OK)
		return status;
	if (sums)
		write_chain(written.stream, "+", images);
	else
		write_weighted_variances(written.stream, weight, images);
	return close_text(&written, text, error);
}

/* --- geometry --- */

enum geometry {
	GEOMETRY_NONE,
	GEOMETRY_COVER,
	GEOMETRY_MEAN,
	GEOMETRY_UNIT, /* a component of a unit vector */
	GEOMETRY_ID
};

/* A geometry channel: "film2.N.X" has the prefix "film2.", and is covered by "film2.cover". */
struct part {
	enum geometry kind;
	const char *name; /* of the channel */
	int stem;         /* bytes of it before X, Y or Z */
	char cover[64];   /* the channel; "": all is covered */
	const double *weight;
	size_t images;
};

/* Bytes of "film12." at the start of a name, or 0. */
static int
prefix_length(const char *name, const char *kind)
{
	size_t length = strlen(kind), digits;

	if (strncmp(name, kind, length) != 0)
		return 0;
	digits = strspn(name + length, "0123456789");
	return digits > 0 && digits < 8 && name[length + digits] == '.'
		       ? (int)(length + digits + 1)
		       : 0;
}

static int
is_vector(const char *name, const char *vector)
{
	size_t length = strlen(vector);

	return strncmp(name, vector, length) == 0 && name[length] == '.' &&
	       name[length + 1] >= 'X' && name[length + 1] <= 'Z' &&
	       name[length + 2] == '\0';
}

static enum geometry
kind_of(const char *rest)
{
	static const char *const unit[] = {"N", "Ns", "Tan", "I"};

	for (int i = 0; i < 4; i++)
		if (is_vector(rest, unit[i]))
			return GEOMETRY_UNIT;
	if (is_vector(rest, "P") || is_vector(rest, "Q") || strcmp(rest, "cosine") == 0 ||
		strcmp(rest, "u") == 0 || strcmp(rest, "v") == 0)
		return GEOMETRY_MEAN;
	if (strcmp(rest, "id") == 0)
		return GEOMETRY_ID;
	return strcmp(rest, "cover") == 0 ? GEOMETRY_COVER : GEOMETRY_NONE;
}

/* Whether all images have the channel, of whole numbers or of none. */
static int
all_have(const struct spec_match *input, size_t images, const char *name, int whole)
{
	for (size_t i = 0; i < images; i++) {
		const struct spec_image *image = input[i].image;
		size_t channel = spec_image_find_channel(image, name);

		if (channel == image->channels ||
			(image->channel[channel].sample == SPEC_SAMPLE_UINT) != whole)
			return 0;
	}
	return 1;
}

/* The weight of image i: "4*image1.("cover")". */
static void
write_share(FILE *to, const struct part *part, size_t i)
{
	fprintf(to, "%.17g", part->weight ? part->weight[i] : 1);
	if (part->cover[0])
		fprintf(to, "*image%zu.(\"%s\")", i + 1, part->cover);
}

/* The sum of the channel's values by their shares; axis: in place of its own, or 0. */
static void
write_sum(FILE *to, const struct part *part, char axis)
{
	for (size_t i = 0; i < part->images; i++) {
		fputs(i > 0 ? "+" : "", to);
		write_share(to, part, i);
		if (axis)
			fprintf(to, "*image%zu.(\"%.*s%c\")", i + 1, part->stem, part->name,
				axis);
		else
			fprintf(to, "*image%zu.(\"%s\")", i + 1, part->name);
	}
	fputc(';', to);
}

static void
write_shares(FILE *to, const struct part *part)
{
	for (size_t i = 0; i < part->images; i++) {
		fputs(i > 0 ? "+" : "all=", to);
		write_share(to, part, i);
	}
	fputc(';', to);
}

static void
write_part(FILE *to, const struct part *part)
{
	switch (part->kind) {
	case GEOMETRY_UNIT:
		fputs("vx=", to);
		write_sum(to, part, 'X');
		fputs("vy=", to);
		write_sum(to, part, 'Y');
		fputs("vz=", to);
		write_sum(to, part, 'Z');
		fprintf(to, "norm=sqrt(vx^2+vy^2+vz^2);norm>0?v%c/norm:0",
			"xyz"[part->name[part->stem] - 'X']);
		break;
	case GEOMETRY_ID:
		fprintf(to, "most=");
		write_share(to, part, 0);
		fprintf(to, ";is=image1.(\"%s\");", part->name);
		for (size_t i = 1; i < part->images; i++) {
			fputs("this=", to);
			write_share(to, part, i);
			fprintf(to,
				";is=this>most?image%zu.(\"%s\"):is;most=max(this,most);",
				i + 1, part->name);
		}
		fputs("is", to);
		break;
	default:
		fputs("sum=", to);
		write_sum(to, part, 0);
		write_shares(to, part);
		fputs("all>0?sum/all:0", to);
		break;
	}
}

enum spec_status
spec_formula_geometry(const struct spec_match *input, const double *weight, size_t images,
	const struct spec_channel *channel, char **text, struct spec_error *error)
{
	struct part part = {.name = channel->name, .weight = weight, .images = images};
	const char *name = channel->name;
	int prefix = prefix_length(name, "film"), lamp = prefix_length(name, "lamp");
	struct spec_text written;
	enum spec_status status;

	*text = NULL;
	part.kind = kind_of(name + prefix);
	if (lamp > 0 && is_vector(name + lamp, "D"))
		part.kind = GEOMETRY_UNIT;
	part.stem = (int)strlen(name) - 1;
	if (part.kind == GEOMETRY_NONE ||
		!all_have(input, images, name, part.kind == GEOMETRY_ID))
		return SPEC_OK;
	if (part.kind != GEOMETRY_COVER)
		snprintf(part.cover, sizeof part.cover, "%.*scover", prefix, name);
	if (!all_have(input, images, part.cover, 0))
		part.cover[0] = '\0';
	status = spec_text_open(&written, error);
	if (status != SPEC_OK)
		return status;
	write_part(written.stream, &part);
	return close_text(&written, text, error);
}
