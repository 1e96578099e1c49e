#include "render/sums.h"

#include <stdio.h>
#include <string.h>

static const char *const names[SPEC_SUMS_GEOMETRY] = {"P.X", "P.Y", "P.Z", "N.X", "N.Y",
	"N.Z", "Ns.X", "Ns.Y", "Ns.Z", "I.X", "I.Y", "I.Z", "Tan.X", "Tan.Y", "Tan.Z",
	"Q.X", "Q.Y", "Q.Z", "u", "v", "cosine", "cover", "id"};

static void
add_vector(double *sum, struct spec_vector v)
{
	sum[0] += v.x;
	sum[1] += v.y;
	sum[2] += v.z;
}

void
spec_sums_add(double *geometry, struct spec_sums_ids *ids, const struct spec_hit *hit,
	struct spec_vector eye, uint32_t id)
{
	size_t i = 0;

	add_vector(geometry + SPEC_SUMS_POINT, hit->point);
	add_vector(geometry + SPEC_SUMS_NORMAL, hit->normal);
	add_vector(geometry + SPEC_SUMS_SHADING, hit->shading);
	add_vector(geometry + SPEC_SUMS_EYE, eye);
	add_vector(geometry + SPEC_SUMS_TANGENT, hit->tangent);
	add_vector(geometry + SPEC_SUMS_OBJECT, hit->object);
	geometry[SPEC_SUMS_U] += hit->u;
	geometry[SPEC_SUMS_V] += hit->v;
	geometry[SPEC_SUMS_COSINE] += spec_vector_dot(hit->shading, eye);
	geometry[SPEC_SUMS_COVER] += 1;
	while (i < ids->ids && ids->id[i] != id)
		i++;
	if (i == SPEC_SUMS_IDS)
		return;
	if (i == ids->ids) {
		ids->id[ids->ids++] = id;
		ids->count[i] = 0;
	}
	ids->count[i]++;
}

static void
make_unit(double *sum)
{
	struct spec_vector v =
		spec_vector_unit((struct spec_vector){sum[0], sum[1], sum[2]});

	sum[0] = v.x;
	sum[1] = v.y;
	sum[2] = v.z;
}

void
spec_sums_finish(double *geometry, const struct spec_sums_ids *ids, unsigned samples)
{
	double seen = geometry[SPEC_SUMS_COVER];
	size_t best = 0;

	if (seen == 0)
		return;
	for (size_t i = 0; i < SPEC_SUMS_COVER; i++)
		geometry[i] /= seen;
	geometry[SPEC_SUMS_COVER] = seen / samples;
	make_unit(geometry + SPEC_SUMS_NORMAL);
	make_unit(geometry + SPEC_SUMS_SHADING);
	make_unit(geometry + SPEC_SUMS_EYE);
	make_unit(geometry + SPEC_SUMS_TANGENT);
	for (size_t i = 1; i < ids->ids; i++) {
		if (ids->count[i] > ids->count[best])
			best = i;
	}
	geometry[SPEC_SUMS_ID] = ids->id[best];
}

enum spec_status
spec_sums_add_channels(
	struct spec_image *image, const char *prefix, struct spec_error *error)
{
	enum spec_status status = SPEC_OK;
	char name[64];

	for (size_t i = 0; i < SPEC_SUMS_GEOMETRY && status == SPEC_OK; i++) {
		snprintf(name, sizeof name, "%s%s", prefix, names[i]);
		status = spec_image_add_channel(image, name,
			i == SPEC_SUMS_ID ? SPEC_SAMPLE_UINT : SPEC_SAMPLE_FLOAT, error);
	}
	return status;
}

size_t
spec_sums_slot(const char *name)
{
	size_t i = 0;

	while (i < SPEC_SUMS_GEOMETRY && strcmp(name, names[i]) != 0)
		i++;
	return i;
}
