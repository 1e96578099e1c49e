/*
 * Meshes of triangles in PLY files, ASCII and binary of either byte order.
 *
 * Read are of the element "vertex" the properties x y z, nx ny nz and u v (also s t,
 * texture_u texture_v, texture_s texture_t), and of "face" the list vertex_indices or
 * vertex_index, of 3 vertices, or of 4, which become two triangles 0 1 2 and 0 2 3. Other
 * elements and properties are stepped over.
 */
#ifndef SPEC_SCENE_PLY_H
#define SPEC_SCENE_PLY_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/error.h"

#define SPEC_PLY_MOST 2147483647     /* vertices, and faces */
#define SPEC_PLY_MOST_ELEMENTS 16    /* kinds of them */
#define SPEC_PLY_MOST_PROPERTIES 128 /* of all elements together */
#define SPEC_PLY_LONGEST_LINE 4096   /* bytes of a line of the header */

struct spec_ply {
	size_t vertices, triangles; /* >= 1 once read */
	float *point;               /* [3 * vertices] */
	float *normal;              /* [3 * vertices], or null */
	float *uv;                  /* [2 * vertices], or null */
	uint32_t *index;            /* [3 * triangles], below vertices */
};

/*
 * Reads a mesh from file up to its end. name stands for the file in messages, which begin
 * "name:line: " where there are lines.
 * SPEC_EFORMAT: no PLY file, damaged, too short or too long for its header, no faces.
 * SPEC_ERANGE: a limit above. SPEC_EUNSUPPORTED: it is compressed, or a face has not 3 or 4
 * vertices. SPEC_EIO, SPEC_ENOMEM. On an error mesh is empty.
 */
enum spec_status spec_ply_read(
	FILE *file, const char *name, struct spec_ply *mesh, struct spec_error *error);

/* As spec_ply_read, from the file at path; SPEC_EIO also where it cannot be opened. */
enum spec_status spec_ply_load(
	const char *path, struct spec_ply *mesh, struct spec_error *error);

/* Frees what mesh holds and leaves it empty; null or empty is allowed. */
void spec_ply_free(struct spec_ply *mesh);

#endif
