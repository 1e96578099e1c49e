#include "colour/sigmoids.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/parallel.h"
#include "base/vector.h"

/* As the build tree and an installation have it: seen from the folder of the program. */
#define SHARE "../share/spectools/upsampling/srgb.sigmoids"

#define MAGIC "spectools sigmoids 1\n"
#define BYTE_ORDER_MARK 0x01020304u

/*
 * The brightest grey of the table: beyond it the polynomial grows without bound, and would
 * draw all colours of the cells beside white with it. Greys themselves need no table.
 */
#define BRIGHTEST_GREY .9995

/* S of this is 1 in float: a spectrum that is level. */
#define LEVEL_C2 65536.f

/* Stands at the beginning of a file; the coefficients follow. */
struct header {
	char magic[32];
	uint32_t order, side;
	double middle_nm, half_nm;
	char rest[8];
};

static double
smooth(double u)
{
	return u * u * (3 - 2 * u);
}

/* The last cell that begins at or below each key; key(at) grows with at, from 0 to 1. */
static void
set_guesses(struct spec_sigmoids_axis *axis, size_t side, double (*key)(double))
{
	size_t cell = 0;

	for (size_t i = 0; i < SPEC_SIGMOIDS_KEYS; i++) {
		while (cell + 2 < side &&
			key(axis->at[cell + 1]) * (SPEC_SIGMOIDS_KEYS - 1) <= (double)i)
			cell++;
		axis->guess[i] = (unsigned char)cell;
	}
}

static double
itself(double value)
{
	return value;
}

static void
set_axes(struct spec_sigmoids *sigmoids)
{
	struct spec_sigmoids_axis *share = &sigmoids->share, *level = &sigmoids->level;
	size_t last = sigmoids->side - 1;

	for (size_t i = 0; i <= last; i++) {
		share->at[i] = (float)smooth((double)i / (double)last);
		level->at[i] = (float)smooth(smooth((double)i / (double)last));
	}
	for (size_t i = 0; i <= last; i++)
		sigmoids->place[i] = -1 / sqrtf(level->at[i > 0 ? i : 1]);
	for (size_t i = 0; i < last; i++) {
		share->rate[i] = 1 / (share->at[i + 1] - share->at[i]);
		level->rate[i] =
			i > 0 ? 1 / (sigmoids->place[i + 1] - sigmoids->place[i]) : 0;
	}
	set_guesses(share, sigmoids->side, itself);
	set_guesses(level, sigmoids->side, sqrt);
}

static size_t
count_floats(size_t side)
{
	return 9 * side * side * side + 1;
}

/* Solving */

struct work {
	const struct spec_upsampler *upsampler;
	const struct spec_sigmoids *sigmoids;
	float *coefficient;
	atomic_size_t next; /* row to be done */
};

/* The colour of a cell, in double so that the fit meets it. */
static void
colour_of(const struct spec_sigmoids *sigmoids, size_t largest, size_t z, size_t y,
	size_t x, double rgb[3])
{
	double level = sigmoids->level.at[z];

	rgb[largest] = level;
	rgb[(largest + 1) % 3] = level * sigmoids->share.at[x];
	rgb[(largest + 2) % 3] = level * sigmoids->share.at[y];
	if (x == sigmoids->side - 1 && y == x && level > BRIGHTEST_GREY)
		rgb[0] = rgb[1] = rgb[2] = BRIGHTEST_GREY;
}

static void
store(const struct spec_sigmoids *sigmoids, const struct spec_sigmoid *sigmoid, float *to)
{
	double a = sigmoid->c0_per_nm2, b = sigmoid->c1_per_nm;
	double middle = sigmoids->middle_nm, half = sigmoids->half_nm;

	to[0] = (float)(a * half * half);
	to[1] = (float)((b + 2 * a * middle) * half);
	to[2] = (float)((a * middle + b) * middle + sigmoid->c2);
}

/* Fits a cell from the spectrum of another with the same x and y, or a start of its own. */
static struct spec_sigmoid
solve_cell(const struct work *work, const size_t cell[4], size_t from,
	const struct spec_sigmoid *near)
{
	const struct spec_sigmoids *sigmoids = work->sigmoids;
	size_t side = sigmoids->side, z = cell[1];
	/* A darker colour has a polynomial that is as much larger. */
	double rgb[3], share = z < from ? sigmoids->place[z] / sigmoids->place[from] : 1;
	struct spec_sigmoid start = *near, found;

	start.c0_per_nm2 *= share;
	start.c1_per_nm *= share;
	start.c2 *= share;
	colour_of(sigmoids, cell[0], z, cell[2], cell[3], rgb);
	spec_upsample_albedo_from(work->upsampler, rgb, &start, &found, NULL);
	store(sigmoids, &found,
		work->coefficient +
			3 * (((cell[0] * side + z) * side + cell[2]) * side + cell[3]));
	return found;
}

/*
 * The cells of one x and y, from the middle of z, where fits are easy, to both ends.
 * middle: a start there; it becomes what was found.
 */
static void
solve_column(const struct work *work, size_t largest, size_t y, size_t x,
	struct spec_sigmoid *middle)
{
	size_t side = work->sigmoids->side, half = side / 2;
	size_t cell[4] = {largest, half, y, x};
	struct spec_sigmoid last;

	*middle = solve_cell(work, cell, half, middle);
	last = *middle;
	for (size_t z = half + 1; z < side; z++) {
		cell[1] = z;
		last = solve_cell(work, cell, z - 1, &last);
	}
	last = *middle;
	for (size_t z = half; z-- > 1;) {
		cell[1] = z;
		last = solve_cell(work, cell, z + 1, &last);
	}
}

/* Rows of x for one y and one largest component, until all are done. */
static void
solve_rows(void *argument, int worker)
{
	struct work *work = argument;
	size_t side = work->sigmoids->side, row;

	(void)worker;
	while ((row = atomic_fetch_add(&work->next, 1)) < 3 * side) {
		struct spec_sigmoid middle = {.scale = 1};

		for (size_t x = 0; x < side; x++)
			solve_column(work, row / side, row % side, x, &middle);
	}
}

/* The cells of z = 0 are those of the next: dark colours are multiples of them. */
static void
fill_black(size_t side, float *coefficient)
{
	size_t plane = 3 * side * side;

	for (size_t l = 0; l < 3; l++)
		memcpy(coefficient + l * side * plane, coefficient + (l * side + 1) * plane,
			plane * sizeof *coefficient);
}

enum spec_status
spec_sigmoids_solve(const struct spec_upsampler *upsampler, size_t side, int threads,
	struct spec_sigmoids *sigmoids, struct spec_error *error)
{
	double first_nm = upsampler->wavelength_nm[0];
	double last_nm = upsampler->wavelength_nm[upsampler->count - 1];
	struct work work = {.upsampler = upsampler, .sigmoids = sigmoids};
	enum spec_status status;

	*sigmoids = (struct spec_sigmoids){.side = side,
		.middle_nm = .5 * (first_nm + last_nm),
		.half_nm = .5 * (last_nm - first_nm)};
	if (side < SPEC_SIGMOIDS_LEAST || side > SPEC_SIGMOIDS_MOST)
		return spec_error_set(error, SPEC_ERANGE,
			"a table of sigmoids has a side of %d to %d, not %zu",
			SPEC_SIGMOIDS_LEAST, SPEC_SIGMOIDS_MOST, side);
	set_axes(sigmoids);
	work.coefficient = spec_memory_new(
		count_floats(side), sizeof *work.coefficient, "coefficients", error);
	if (!work.coefficient)
		return SPEC_ENOMEM;
	sigmoids->memory = work.coefficient;
	sigmoids->coefficient = work.coefficient;
	status = spec_parallel_run(threads, solve_rows, &work, error);
	fill_black(side, work.coefficient);
	if (status != SPEC_OK)
		spec_sigmoids_free(sigmoids);
	return status;
}

/* Files */

enum spec_status
spec_sigmoids_save(
	const struct spec_sigmoids *sigmoids, const char *path, struct spec_error *error)
{
	struct header header = {.magic = MAGIC,
		.order = BYTE_ORDER_MARK,
		.side = (uint32_t)sigmoids->side,
		.middle_nm = sigmoids->middle_nm,
		.half_nm = sigmoids->half_nm};
	struct spec_output output;
	enum spec_status status = spec_output_open(&output, path, error);

	if (status != SPEC_OK)
		return status;
	status = spec_output_write(&output, &header, sizeof header, error);
	if (status == SPEC_OK)
		status = spec_output_write(&output, sigmoids->coefficient,
			count_floats(sigmoids->side) * sizeof(float), error);
	if (status == SPEC_OK)
		return spec_output_commit(&output, error);
	spec_output_abandon(&output);
	return status;
}

static enum spec_status
take_header(struct spec_sigmoids *sigmoids, const char *path, struct spec_error *error)
{
	const struct header *header = sigmoids->memory;

	if (sigmoids->mapped < sizeof *header ||
		memcmp(header->magic, MAGIC, sizeof MAGIC) != 0)
		return spec_error_set(
			error, SPEC_EFORMAT, "'%s' is no table of sigmoids", path);
	if (header->order != BYTE_ORDER_MARK)
		return spec_error_set(error, SPEC_EFORMAT,
			"'%s' was made on another kind of computer", path);
	if (header->side < SPEC_SIGMOIDS_LEAST || header->side > SPEC_SIGMOIDS_MOST ||
		!(header->half_nm > 0 && fabs(header->middle_nm) <= 1e6))
		return spec_error_set(
			error, SPEC_EFORMAT, "'%s' has a damaged header", path);
	sigmoids->side = header->side;
	sigmoids->middle_nm = header->middle_nm;
	sigmoids->half_nm = header->half_nm;
	if (sigmoids->mapped != sizeof *header + count_floats(header->side) * sizeof(float))
		return spec_error_set(error, SPEC_EFORMAT,
			"'%s' has %zu bytes instead of %zu", path, sigmoids->mapped,
			sizeof *header + count_floats(header->side) * sizeof(float));
	sigmoids->coefficient = (const float *)(header + 1);
	return SPEC_OK;
}

static enum spec_status
map_file(const char *path, struct spec_sigmoids *sigmoids, struct spec_error *error)
{
	int file = open(path, O_RDONLY | O_CLOEXEC);
	enum spec_status status = SPEC_OK;
	struct stat about;
	void *memory = MAP_FAILED;

	if (file < 0)
		return spec_error_system(error, errno, "unable to open '%s'", path);
	if (fstat(file, &about) != 0)
		status = spec_error_system(error, errno, "unable to look at '%s'", path);
	else if (!S_ISREG(about.st_mode) || about.st_size == 0)
		status = spec_error_set(
			error, SPEC_EFORMAT, "'%s' is no table of sigmoids", path);
	if (status == SPEC_OK)
		memory = mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE, file, 0);
	if (memory != MAP_FAILED) {
		sigmoids->memory = memory;
		sigmoids->mapped = (size_t)about.st_size;
	} else if (status == SPEC_OK) {
		status = spec_error_system(error, errno, "unable to map '%s'", path);
	}
	(void)close(file);
	return status;
}

enum spec_status
spec_sigmoids_open(
	const char *path, struct spec_sigmoids *sigmoids, struct spec_error *error)
{
	enum spec_status status;

	*sigmoids = (struct spec_sigmoids){0};
	status = map_file(path, sigmoids, error);
	if (status == SPEC_OK)
		status = take_header(sigmoids, path, error);
	if (status == SPEC_OK)
		set_axes(sigmoids);
	else
		spec_sigmoids_free(sigmoids);
	return status;
}

enum spec_status
spec_sigmoids_load(struct spec_sigmoids *sigmoids, struct spec_error *error)
{
	char path[PATH_MAX + sizeof SHARE];
	ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
	char *slash;

	*sigmoids = (struct spec_sigmoids){0};
	path[length > 0 && length < PATH_MAX ? length : 0] = '\0';
	slash = strrchr(path, '/');
	if (!slash)
		return spec_error_set(error, SPEC_EIO,
			"the table of sigmoids was not found: /proc/self/exe cannot be used");
	memcpy(slash + 1, SHARE, sizeof SHARE);
	return spec_sigmoids_open(path, sigmoids, error);
}

void
spec_sigmoids_free(struct spec_sigmoids *sigmoids)
{
	if (!sigmoids)
		return;
	if (sigmoids->mapped)
		(void)munmap(sigmoids->memory, sigmoids->mapped);
	else
		free(sigmoids->memory);
	*sigmoids = (struct spec_sigmoids){0};
}

/* Looking up */

#define RUN 64 /* colours looked up at a time */

typedef float four __attribute__((vector_size(16)));

/* Where colours lie in the table. */
struct places {
	float x[RUN], y[RUN], level[RUN], root[RUN];
	int largest[RUN];
};

/* The places of colours, and their scales. */
SPEC_VECTORISED static void
find_places(const float *r, const float *g, const float *b, size_t count, float darkest,
	struct places *places, float *restrict scale)
{
	for (size_t i = 0; i < count; i++) {
		float rg = r[i] > g[i] ? r[i] : g[i], most = rg > b[i] ? rg : b[i];
		float divisor = most > 0 ? most : 1; /* one over it may be infinite */
		int blue = b[i] >= rg, green = !blue & (g[i] >= r[i]);
		float next = blue ? r[i] : green ? b[i] : g[i];
		float after = blue ? g[i] : green ? r[i] : b[i];
		float level = most > darkest ? most : darkest;

		places->largest[i] = blue ? 2 : green;
		places->x[i] = next / divisor;
		places->y[i] = after / divisor;
		places->level[i] = level;
		places->root[i] = sqrtf(level);
		scale[i] = most < darkest ? most / darkest : 1;
	}
}

/* The cell of a value: the largest i with at[i] <= value, but at most the last but one. */
static inline size_t
find_cell(const struct spec_sigmoids_axis *axis, size_t side, float key, float value)
{
	size_t i = axis->guess[(size_t)(key * (SPEC_SIGMOIDS_KEYS - 1))];

	while (i + 2 < side && axis->at[i + 1] <= value)
		i++;
	return i;
}

static inline four
read_four(const float *at)
{
	four value;

	memcpy(&value, at, sizeof value);
	return value;
}

/* Between a cell and the next of x. */
static inline four
along_x(const float *cell, float x)
{
	four near = read_four(cell);

	return near + x * (read_four(cell + 3) - near);
}

/* The coefficients of a place, and a number more. */
static inline four
interpolate(const struct spec_sigmoids *sigmoids, const struct places *places, size_t n)
{
	const struct spec_sigmoids_axis *share = &sigmoids->share;
	const struct spec_sigmoids_axis *level = &sigmoids->level;
	size_t side = sigmoids->side, row = 3 * side, plane = row * side;
	float x = places->x[n], y = places->y[n];
	size_t i = find_cell(share, side, x, x), j = find_cell(share, side, y, y);
	size_t k = find_cell(level, side, places->root[n], places->level[n]);
	const float *cell = sigmoids->coefficient +
			    ((size_t)places->largest[n] * side + k) * plane + j * row +
			    3 * i;
	float z = (-1 / places->root[n] - sigmoids->place[k]) * level->rate[k];
	four low, high;

	x = (x - share->at[i]) * share->rate[i];
	y = (y - share->at[j]) * share->rate[j];
	low = along_x(cell, x);
	low += y * (along_x(cell + row, x) - low);
	high = along_x(cell + plane, x);
	high += y * (along_x(cell + plane + row, x) - high);
	return low + z * (high - low);
}

static void
look_up_run(const struct spec_sigmoids *sigmoids, const float *rgb[3], size_t count,
	float *c0, float *c1, float *c2, float *scale)
{
	struct places places;

	find_places(rgb[0], rgb[1], rgb[2], count, sigmoids->level.at[1], &places, scale);
	for (size_t i = 0; i < count; i++) {
		four c = {0, 0, LEVEL_C2, 0};

		if (rgb[0][i] == rgb[1][i] && rgb[1][i] == rgb[2][i])
			scale[i] = rgb[0][i];
		else
			c = interpolate(sigmoids, &places, i);
		c0[i] = c[0];
		c1[i] = c[1];
		c2[i] = c[2];
	}
}

void
spec_sigmoids_look_up(const struct spec_sigmoids *sigmoids, const float *r, const float *g,
	const float *b, size_t count, float *c0, float *c1, float *c2, float *scale)
{
	for (size_t i = 0; i < count; i += RUN) {
		const float *rgb[3] = {r + i, g + i, b + i};

		look_up_run(sigmoids, rgb, count - i < RUN ? count - i : RUN, c0 + i,
			c1 + i, c2 + i, scale + i);
	}
}

void
spec_sigmoids_find(const struct spec_sigmoids *sigmoids, const double rgb[3],
	struct spec_sigmoid *sigmoid)
{
	float r = (float)rgb[0], g = (float)rgb[1], b = (float)rgb[2], c0, c1, c2, scale;
	double half = sigmoids->half_nm, middle = sigmoids->middle_nm;

	spec_sigmoids_look_up(sigmoids, &r, &g, &b, 1, &c0, &c1, &c2, &scale);
	sigmoid->scale = scale;
	sigmoid->c0_per_nm2 = c0 / (half * half);
	sigmoid->c1_per_nm = c1 / half - 2 * sigmoid->c0_per_nm2 * middle;
	sigmoid->c2 = (sigmoid->c0_per_nm2 * middle - c1 / half) * middle + c2;
}
