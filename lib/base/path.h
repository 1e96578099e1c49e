/* Parts of a file's path. */
#ifndef SPEC_BASE_PATH_H
#define SPEC_BASE_PATH_H

/* Where the last component begins: "c.exr" of "a/b/c.exr". */
const char *spec_path_name(const char *path);

/*
 * Where the last component's last suffix begins, with its dot; else its end, "". A dot at the
 * component's beginning hides a file and begins no suffix.
 */
const char *spec_path_suffix(const char *path);

/* Whether that is this suffix, such as ".spd", in upper or lower case. */
int spec_path_has_suffix(const char *path, const char *suffix);

#endif
