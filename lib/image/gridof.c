#include "image/gridof.h"

#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "image/kind.h"
#include "image/reader.h"
#include "spectrum/curve.h"
#include "spectrum/lookup.h"

static enum spec_status
copy_edges(const struct spec_image *image, double **edges_nm, struct spec_error *error)
{
	size_t count = image->bands + 1;

	if (!image->edges_nm)
		return SPEC_OK;
	*edges_nm = spec_memory_new(count, sizeof **edges_nm, "edges", error);
	if (!*edges_nm)
		return SPEC_ENOMEM;
	memcpy(*edges_nm, image->edges_nm, count * sizeof **edges_nm);
	return SPEC_OK;
}

static enum spec_status
grid_of_image(const char *path, const struct spec_settings *settings,
	struct spec_grid *grid, double **edges_nm, struct spec_error *error)
{
	struct spec_reader *reader = NULL;
	enum spec_status status = spec_reader_open(&reader, path, settings, error);
	const struct spec_image *image = reader ? spec_reader_image(reader) : NULL;

	if (status == SPEC_OK && image->bands == 0)
		status = spec_error_set(error, SPEC_EFORMAT,
			"%s: has no spectral channel to take a grid from", path);
	if (status == SPEC_OK)
		status = spec_grid_copy(
			&(struct spec_grid){image->wavelength_nm, image->bands}, grid,
			error);
	if (status == SPEC_OK)
		status = copy_edges(image, edges_nm, error);
	spec_reader_close(reader);
	if (status != SPEC_OK)
		spec_grid_free(grid);
	return status;
}

enum spec_status
spec_grid_of(const char *text, const struct spec_settings *settings, struct spec_grid *grid,
	double **edges_nm, struct spec_error *error)
{
	struct spec_curve curve = {0};
	enum spec_status status;

	*grid = (struct spec_grid){0};
	*edges_nm = NULL;
	if (!*text || (strchr(text, ':') && access(text, F_OK) != 0))
		return spec_grid_parse(text, grid, error);
	if (!spec_kind_is_curve(text))
		return grid_of_image(text, settings, grid, edges_nm, error);
	status = spec_lookup_curve(text, &curve, error);
	if (status == SPEC_OK)
		status = spec_grid_copy(
			&(struct spec_grid){curve.wavelength_nm, curve.count}, grid, error);
	else
		spec_error_prefix(error, "--grid takes LO:HI:STEP, an image or a curve");
	spec_curve_free(&curve);
	return status;
}
