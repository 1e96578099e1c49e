/* Fuzzes what reads channel names and numbers: the bytes are one name. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/names.h"

#include "fuzz.h"

/* A band's name in the layout is read as the band that it names, to six decimals. */
static void
write_back(const struct spec_channel *channel)
{
	struct spec_channel again = {0};
	char name[128];

	if (channel->wavelength_nm < 1 || channel->reradiated_nm < 1)
		return; /* six decimals would not be enough */
	spec_names_write(name, sizeof name, channel->role, channel->stokes,
		channel->wavelength_nm, channel->reradiated_nm);
	again.name = name;
	require(spec_names_read(&again, NULL) == SPEC_OK, "a written name cannot be read");
	if (channel->role != SPEC_ROLE_BISPECTRAL)
		require(again.role == channel->role, "another role");
	require(fabs(again.wavelength_nm - channel->wavelength_nm) < 1e-6, "another band");
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	struct spec_channel channel = {0};
	struct spec_error error = {0};
	char *text = malloc(size + 1);
	long long whole;
	double value;

	if (!text)
		return 0;
	memcpy(text, data, size);
	text[size] = '\0';
	channel.name = text;
	if (spec_names_read(&channel, &error) != SPEC_OK) {
		require(error.message[0], "a failure without a message");
	} else if (channel.role != SPEC_ROLE_OTHER) {
		require(channel.wavelength_nm >= SPEC_NAMES_SHORTEST_NM &&
				channel.wavelength_nm <= SPEC_NAMES_LONGEST_NM,
			"a wavelength out of range");
		write_back(&channel);
	}
	require(spec_number_scan(text, ',', &value) <= strlen(text), "beyond the text");
	require(spec_number_scan(text, '.', &value) <= strlen(text), "beyond the text");
	if (spec_number_parse(text, -1, 1, "number", &value, &error) == SPEC_OK)
		require(value >= -1 && value <= 1, "a number out of range");
	if (spec_number_parse_bytes(text, "size", &whole, &error) == SPEC_OK)
		require(whole >= 0, "a negative size");
	if (spec_number_parse_length(text, "length", &value, &error) == SPEC_OK)
		require(value > 0 && isfinite(value), "a length that is none");
	free(text);
	return 0;
}
