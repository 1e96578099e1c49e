#include "colour/transfer.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

const struct spec_transfer spec_transfer_linear = {
	"linear", "no encoding", 1, 0, 1, 1, 0, 0, 8};

const struct spec_transfer spec_transfer_srgb = {
	"srgb", "IEC 61966-2-1:1999", 12.92, .0031308, 1.055, 1 / 2.4, .055, .04045, 13};

/* The constants as they are printed: the parts meet within 2.5e-4. */
const struct spec_transfer spec_transfer_rec709 = {
	"rec709", "ITU-R BT.709-6:2015, item 1.2", 4.5, .018, 1.099, .45, .099, .081, 1};

/* Table 4's note: the solution by which value and slope of the two parts are equal. */
#define ALPHA 1.09929682680944
#define BETA .018053968510807
const struct spec_transfer spec_transfer_rec2020 = {"rec2020",
	"ITU-R BT.2020-2:2015, table 4", 4.5, BETA, ALPHA, .45, ALPHA - 1, 4.5 * BETA, 14};

/* Adobe RGB (1998) Color Image Encoding, 2005-05, 4.3.4.2: 2 + 51/256. */
const struct spec_transfer spec_transfer_adobe = {
	"adobe", "Adobe RGB (1998), 2005-05", 0, 0, 1, 256. / 563, 0, 0, 0};

/* H.273's code 17 has 48/52.37 of the light, which this has not. */
const struct spec_transfer spec_transfer_dci = {
	"dci", "SMPTE RP 431-2:2011", 0, 0, 1, 1 / 2.6, 0, 0, 0};

/* H.273 has a code for one power. */
#define CICP_GAMMA 2.2
#define CICP_OF_GAMMA 4

#define TRANSFERS 6
static const struct spec_transfer *const transfers[TRANSFERS] = {&spec_transfer_linear,
	&spec_transfer_srgb, &spec_transfer_rec709, &spec_transfer_rec2020,
	&spec_transfer_adobe, &spec_transfer_dci};

const struct spec_transfer *
spec_transfer_at(size_t index)
{
	return index < TRANSFERS ? transfers[index] : NULL;
}

const struct spec_transfer *
spec_transfer_find(const char *name, struct spec_error *error)
{
	for (size_t i = 0; spec_transfer_at(i); i++)
		if (strcmp(transfers[i]->name, name) == 0)
			return transfers[i];
	spec_error_set(error, SPEC_EUSAGE,
		"unknown transfer function '%s': expected linear, srgb, rec709, rec2020, "
		"adobe, dci or gamma:G",
		name);
	return NULL;
}

const struct spec_transfer *
spec_transfer_parse(const char *text, struct spec_transfer *own, struct spec_error *error)
{
	static const char prefix[] = "gamma:";
	double gamma;

	if (strncmp(text, prefix, strlen(prefix)) != 0)
		return spec_transfer_find(text, error);
	if (spec_number_parse(text + strlen(prefix), 1, SPEC_TRANSFER_MOST_GAMMA,
		    "the gamma of a transfer function", &gamma, error) != SPEC_OK) {
		if (error)
			error->status = SPEC_EUSAGE;
		return NULL;
	}
	if (gamma == 1)
		return &spec_transfer_linear;
	*own = (struct spec_transfer){.name = text,
		.source = "a power",
		.scale = 1,
		.power = 1 / gamma,
		.cicp = gamma == CICP_GAMMA ? CICP_OF_GAMMA : 0};
	return own;
}

double
spec_transfer_encode(const struct spec_transfer *transfer, double linear)
{
	if (linear <= transfer->cut)
		return transfer->slope * linear;
	if (transfer->power == 1)
		return linear;
	return transfer->scale * pow(linear, transfer->power) - transfer->offset;
}

double
spec_transfer_decode(const struct spec_transfer *transfer, double encoded)
{
	if (encoded <= transfer->cut_encoded)
		return transfer->slope > 0 ? encoded / transfer->slope : 0 * encoded;
	if (transfer->power == 1)
		return encoded;
	return pow((encoded + transfer->offset) / transfer->scale, 1 / transfer->power);
}

double
spec_srgb_encode(double linear)
{
	return spec_transfer_encode(&spec_transfer_srgb, linear);
}

double
spec_srgb_decode(double encoded)
{
	return spec_transfer_decode(&spec_transfer_srgb, encoded);
}
