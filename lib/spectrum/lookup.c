#include "spectrum/lookup.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "base/path.h"
#include "spectrum/illuminant.h"
#include "spectrum/spd.h"

#define SUFFIX ".spd"
#define SHARE "../share/spectools/spectra"
#define LONGEST_LAMP sizeof "illuminants/FL12.12"

struct entry {
	char *name; /* as in "illuminants/D65" */
	char *path;
	size_t root; /* the index of its root: lower ones come first */
};

struct catalogue {
	char *roots; /* the folders' names for messages, with " and " between them */
	size_t root_count;
	struct entry *entry;
	size_t count, room;
};

static char *
join(const char *first, const char *between, const char *second, struct spec_error *error)
{
	size_t length = strlen(first) + strlen(between) + strlen(second) + 1;
	char *text = spec_memory_new(length, 1, "bytes of a name", error);

	if (text)
		snprintf(text, length, "%s%s%s", first, between, second);
	return text;
}

/* Adds the file at path, whose full name is name with SUFFIX behind it. */
static enum spec_status
add_entry(struct catalogue *catalogue, const char *name, const char *path,
	struct spec_error *error)
{
	struct entry *entry;
	enum spec_status status = spec_memory_grow((void **)&catalogue->entry,
		&catalogue->room, catalogue->count + 1, sizeof *catalogue->entry,
		"names of spectra", error);

	if (status != SPEC_OK)
		return status;
	entry = &catalogue->entry[catalogue->count];
	entry->name = spec_memory_text(name, strlen(name) - strlen(SUFFIX), error);
	entry->path = spec_memory_text(path, strlen(path), error);
	entry->root = catalogue->root_count;
	catalogue->count++; /* even when half filled: freeing it takes care of the rest */
	return entry->name && entry->path ? SPEC_OK : SPEC_ENOMEM;
}

static enum spec_status add_folder(struct catalogue *catalogue, const char *name,
	const char *path, int levels, struct spec_error *error);

/* Adds what is called item in a folder: a file, or the files of a folder. */
static enum spec_status
add_item(struct catalogue *catalogue, const char *folder_name, const char *folder_path,
	const char *item, int levels, struct spec_error *error)
{
	char *name = join(folder_name, "/", item, error);
	char *path = join(folder_path, "/", item, error);
	enum spec_status status = name && path ? SPEC_OK : SPEC_ENOMEM;
	struct stat about;

	if (status == SPEC_OK && stat(path, &about) == 0) {
		if (S_ISDIR(about.st_mode) && levels > 0)
			status = add_folder(catalogue, name, path, levels - 1, error);
		else if (!S_ISDIR(about.st_mode) && spec_path_has_suffix(item, SUFFIX))
			status = add_entry(catalogue, name, path, error);
	}
	free(name);
	free(path);
	return status;
}

/* Adds the files of a folder, and of folders in it so many levels deep. */
static enum spec_status
add_folder(struct catalogue *catalogue, const char *name, const char *path, int levels,
	struct spec_error *error)
{
	DIR *folder = opendir(path);
	enum spec_status status = SPEC_OK;
	struct dirent *item;

	if (!folder && (errno == ENOENT || errno == ENOTDIR))
		return SPEC_OK;
	if (!folder)
		return spec_error_system(
			error, errno, "unable to read the folder '%s'", path);
	errno = 0;
	while (status == SPEC_OK && (item = readdir(folder))) {
		if (item->d_name[0] != '.')
			status = add_item(
				catalogue, name, path, item->d_name, levels, error);
		errno = 0;
	}
	if (status == SPEC_OK && errno != 0)
		status = spec_error_system(
			error, errno, "unable to read the folder '%s'", path);
	closedir(folder);
	return status;
}

static enum spec_status
add_root(struct catalogue *catalogue, const char *root, struct spec_error *error)
{
	static const char *const groups[] = {"cmf", "illuminants", "glass", "metals",
		"reflectance", "media", "sky", "upsampling"};
	int first = catalogue->root_count == 0;
	char *roots =
		join(first ? "" : catalogue->roots, first ? "" : " and ", root, error);
	enum spec_status status = roots ? SPEC_OK : SPEC_ENOMEM;

	if (status != SPEC_OK)
		return status;
	free(catalogue->roots);
	catalogue->roots = roots;
	for (size_t i = 0; status == SPEC_OK && i < sizeof groups / sizeof groups[0]; i++) {
		char *path = join(root, "/", groups[i], error);

		status = path ? add_folder(catalogue, groups[i], path, 1, error)
			      : SPEC_ENOMEM;
		free(path);
	}
	catalogue->root_count++;
	return status;
}

/* Adds the data that belong to the running program, built or installed. */
static enum spec_status
add_own_root(struct catalogue *catalogue, struct spec_error *error)
{
	char program[PATH_MAX], *root, *whole;
	ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
	enum spec_status status;

	if (length <= 0) /* no /proc here: SPECTRA_PATH has to do */
		return SPEC_OK;
	program[length] = '\0';
	if (strrchr(program, '/'))
		*strrchr(program, '/') = '\0';
	root = join(program, "/", SHARE, error);
	if (!root)
		return SPEC_ENOMEM;
	whole = realpath(root, NULL); /* for the messages; null if it is not there */
	status = add_root(catalogue, whole ? whole : root, error);
	free(whole);
	free(root);
	return status;
}

static int
compare_entries(const void *first, const void *second)
{
	const struct entry *a = first, *b = second;
	int order = strcmp(a->name, b->name);

	return order ? order : (a->root > b->root) - (a->root < b->root);
}

static void
catalogue_close(struct catalogue *catalogue)
{
	for (size_t i = 0; i < catalogue->count; i++) {
		free(catalogue->entry[i].name);
		free(catalogue->entry[i].path);
	}
	free(catalogue->entry);
	free(catalogue->roots);
}

/* Gathers all spectra there are, sorted by name, then by root. */
static enum spec_status
catalogue_open(struct catalogue *catalogue, struct spec_error *error)
{
	const char *at = getenv("SPECTRA_PATH");
	enum spec_status status = SPEC_OK;

	*catalogue = (struct catalogue){0};
	while (status == SPEC_OK && at && *at) {
		size_t length = strcspn(at, ":");
		char *root = spec_memory_text(at, length, error);

		if (!root)
			status = SPEC_ENOMEM;
		else if (length > 0) /* "a::b" has two roots */
			status = add_root(catalogue, root, error);
		free(root);
		at += length + (at[length] == ':');
	}
	if (status == SPEC_OK)
		status = add_own_root(catalogue, error);
	if (status != SPEC_OK)
		catalogue_close(catalogue);
	else if (catalogue->count > 0)
		qsort(catalogue->entry, catalogue->count, sizeof *catalogue->entry,
			compare_entries);
	return status;
}

/* 2: name is the full name, 1: the end of it, 0: neither. */
static int
match(const char *full, const char *name, int (*compare)(const char *, const char *))
{
	size_t full_length = strlen(full), length = strlen(name);

	if (compare(full, name) == 0)
		return 2;
	return full_length > length && full[full_length - length - 1] == '/' &&
	       compare(full + full_length - length, name) == 0;
}

/*
 * The entry that name fits best: in the first root that has any, the one of that full name
 * before those whose end it is. Null if there is none; *other is a second that fits as well.
 */
static const struct entry *
find(const struct catalogue *catalogue, const char *name,
	int (*compare)(const char *, const char *), const struct entry **other)
{
	const struct entry *best = NULL;
	int best_rank = 0;

	*other = NULL;
	for (size_t i = 0; i < catalogue->count; i++) {
		const struct entry *entry = &catalogue->entry[i];
		int rank = match(entry->name, name, compare);

		if (rank == 0 || (best && entry->root > best->root))
			continue;
		if (!best || entry->root < best->root || rank > best_rank) {
			best = entry;
			best_rank = rank;
			*other = NULL;
		} else if (rank == best_rank) {
			*other = entry;
		}
	}
	return best;
}

/* "F4" and "F3.1" are what "FL4" and "FL3.1" were called; whether name is such a lamp's. */
static int
find_fluorescent(const char *name, char full[LONGEST_LAMP])
{
	size_t whole = strspn(name + (*name != '\0'), "0123456789"), part = 0;
	const char *end = name + 1 + whole;

	if ((*name != 'F' && *name != 'f') || whole < 1 || whole > 2)
		return 0;
	if (*end == '.') {
		part = strspn(end + 1, "0123456789");
		end += 1 + part;
	}
	if (*end || part > 2)
		return 0;
	snprintf(full, LONGEST_LAMP, "illuminants/FL%s", name + 1);
	return 1;
}

/* The name to ask for instead, or null if none is near. */
static const char *
suggest(const struct catalogue *catalogue, const char *name)
{
	size_t allowed = strlen(name) / 3 > 1 ? strlen(name) / 3 : 1;
	size_t least = allowed + 1;
	const char *nearest = NULL;

	for (size_t i = 0; i < catalogue->count; i++) {
		const char *full = catalogue->entry[i].name;
		const char *candidate = strchr(name, '/') ? full : strrchr(full, '/') + 1;
		size_t distance = spec_nearest_distance(name, candidate);

		/* "bk7" is meant for "N-BK7", though two characters are missing. */
		if (distance > allowed && strlen(name) > 1 && strcasestr(candidate, name))
			distance = allowed;
		if (distance < least) {
			least = distance;
			nearest = candidate;
		}
	}
	return nearest;
}

int
spec_lookup_is_path(const char *name)
{
	return strchr(name, '/') || spec_path_has_suffix(name, ".spd") ||
	       spec_path_has_suffix(name, ".txt") || spec_path_has_suffix(name, ".csv");
}

static enum spec_status
fail_missing(const struct catalogue *catalogue, const char *name, struct spec_error *error)
{
	char *stem = spec_memory_text(name, strlen(name), error);
	const char *nearest;
	enum spec_status status;

	if (!stem)
		return SPEC_ENOMEM;
	if (spec_path_has_suffix(stem, SUFFIX))
		stem[strlen(stem) - strlen(SUFFIX)] = '\0';
	nearest = suggest(catalogue, stem);
	free(stem);
	status = spec_error_set(error, SPEC_EUSAGE,
		"no spectrum '%.200s': %s in %.500s%s%s%s", name,
		spec_lookup_is_path(name) ? "no such file, nor is it" : "it is not",
		catalogue->roots ? catalogue->roots
				 : "any folder, for SPECTRA_PATH names none",
		nearest ? "; did you mean '" : "", nearest ? nearest : "",
		nearest ? "'?" : "");
	return status;
}

/* The path of the spectrum of that name, to be freed. */
static enum spec_status
find_path(const struct catalogue *catalogue, const char *name, char **path,
	struct spec_error *error)
{
	const struct entry *other, *entry = find(catalogue, name, strcmp, &other);
	char lamp[LONGEST_LAMP];

	if (!entry)
		entry = find(catalogue, name, strcasecmp, &other);
	if (!entry && find_fluorescent(name, lamp))
		entry = find(catalogue, lamp, strcmp, &other);
	if (!entry)
		return fail_missing(catalogue, name, error);
	if (other)
		return spec_error_set(error, SPEC_EUSAGE,
			"the name '%.200s' fits two spectra: %.300s and %.300s", name,
			entry->path, other->path);
	*path = spec_memory_text(entry->path, strlen(entry->path), error);
	return *path ? SPEC_OK : SPEC_ENOMEM;
}

enum spec_status
spec_lookup_path(const char *name, char **path, struct spec_error *error)
{
	struct catalogue catalogue;
	struct stat about;
	enum spec_status status;

	*path = NULL;
	if (spec_lookup_is_path(name) && stat(name, &about) == 0 &&
		!S_ISDIR(about.st_mode)) {
		*path = spec_memory_text(name, strlen(name), error);
		return *path ? SPEC_OK : SPEC_ENOMEM;
	}
	status = catalogue_open(&catalogue, error);
	if (status != SPEC_OK)
		return status;
	status = find_path(&catalogue, name, path, error);
	catalogue_close(&catalogue);
	return status;
}

/* The curve of an illuminant by formula. */
static enum spec_status
calculate(const char *name, struct spec_curve *curve, struct spec_error *error)
{
	struct spec_curve components = {0};
	double temperature_k;
	int daylight;
	enum spec_status status =
		spec_illuminant_parse(name, &daylight, &temperature_k, error);

	*curve = (struct spec_curve){0};
	if (status == SPEC_OK && !daylight)
		return spec_blackbody_curve(temperature_k, curve, error);
	if (status == SPEC_OK)
		status = spec_lookup_curve(
			"illuminants/daylight-components", &components, error);
	if (status == SPEC_OK)
		status = spec_daylight_curve(&components, temperature_k, curve, error);
	spec_curve_free(&components);
	return status;
}

static const struct spec_lookup_maker *maker;

void
spec_lookup_set_maker(const struct spec_lookup_maker *next)
{
	maker = next;
}

int
spec_lookup_is_computed(const char *name)
{
	return spec_illuminant_is_formula(name) || (maker && maker->knows(name));
}

enum spec_status
spec_lookup_curve(const char *name, struct spec_curve *curve, struct spec_error *error)
{
	char *path;
	enum spec_status status;

	if (spec_illuminant_is_formula(name))
		return calculate(name, curve, error);
	if (maker && maker->knows(name))
		return maker->make(name, curve, error);
	status = spec_lookup_path(name, &path, error);
	*curve = (struct spec_curve){0};
	if (status == SPEC_OK)
		status = spec_spd_load(path, curve, error);
	free(path);
	return status;
}

enum spec_status
spec_lookup_list(char ***names, size_t *count, struct spec_error *error)
{
	struct catalogue catalogue;
	enum spec_status status = catalogue_open(&catalogue, error);

	*names = NULL;
	*count = 0;
	if (status != SPEC_OK)
		return status;
	*names = spec_memory_new(catalogue.count, sizeof **names, "names", error);
	if (!*names)
		status = SPEC_ENOMEM;
	for (size_t i = 0; status == SPEC_OK && i < catalogue.count; i++) {
		if (*count > 0 &&
			strcmp((*names)[*count - 1], catalogue.entry[i].name) == 0)
			continue; /* an earlier root has it */
		(*names)[(*count)++] = catalogue.entry[i].name;
		catalogue.entry[i].name = NULL;
	}
	catalogue_close(&catalogue);
	return status;
}

void
spec_lookup_free_list(char **names, size_t count)
{
	for (size_t i = 0; names && i < count; i++)
		free(names[i]);
	free(names);
}

static enum spec_status
refuse(const char *name, struct spec_curve *curve, const char *wanted,
	struct spec_error *error)
{
	enum spec_status status = spec_error_set(
		error, SPEC_EUSAGE, "'%s' is a %s, not %s", name, curve->quantity, wanted);

	spec_curve_free(curve);
	return status;
}

enum spec_status
spec_lookup_light(const char *name, struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = spec_lookup_curve(name, curve, error);

	struct spec_curve lamp;
	char full[LONGEST_LAMP];

	if (status == SPEC_OK && !*curve->title) {
		status = spec_curve_set_text(&curve->title, name, error);
		if (status != SPEC_OK)
			spec_curve_free(curve);
	}
	if (status != SPEC_OK || spec_curve_is_light(curve))
		return status;
	/* F5 is a glass, too. */
	if (!find_fluorescent(name, full) ||
		spec_lookup_curve(full, &lamp, NULL) != SPEC_OK)
		return refuse(name, curve, "light", error);
	spec_curve_free(curve);
	*curve = lamp;
	return SPEC_OK;
}

enum spec_status
spec_lookup_factor(const char *name, struct spec_curve *curve, struct spec_error *error)
{
	enum spec_status status = spec_lookup_curve(name, curve, error);

	if (status != SPEC_OK || spec_curve_is_light(curve) || spec_curve_is_ratio(curve))
		return status;
	return refuse(name, curve, "light, reflectance or transmittance", error);
}
