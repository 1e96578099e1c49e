/* What the parts of an operation's planning share; compare/arithmetic.h is its outside. */
#ifndef SPEC_COMPARE_PLANNING_H
#define SPEC_COMPARE_PLANNING_H

#include "compare/arithmetic.h"
#include "image/layers.h"

struct spec_arithmetic_traits {
	const char *name;
	size_t least, most; /* images */
	int alike;  /* all are of one kind, quantity and the same components and bins */
	int linear; /* so that it holds for Stokes components and bispectral channels, too */
	int alpha;  /* A is worked on as the bands, which are premultiplied by it */
	int layers; /* and so are light layers; it is a sum by weights */
	int mean;   /* of all, so that it has a mean geometry */
};

struct spec_plan {
	struct spec_arithmetic *arithmetic;
	const struct spec_match *input;
	const struct spec_image *image[SPEC_ARITHMETIC_MOST + 1];
	const char *name[SPEC_ARITHMETIC_MOST + 1];
	size_t images, operands; /* the mask's image is no operand */
	const struct spec_arithmetic_setup *setup;
	const struct spec_arithmetic_traits *operation;
	enum spec_role role; /* of the result */
	size_t model; /* the operand of that role, whose components and bins it has */
	const char *quantity;                 /* null: the first image's stays */
	double samples[SPEC_ARITHMETIC_MOST]; /* of MERGE, per pixel */
	const double *weight;                 /* of each operand; null: all are alike */
	struct spec_expression expression;
	struct spec_layers layers[SPEC_ARITHMETIC_MOST];
	struct spec_error *error;
};

/* Whether the images go together; fills the layers, which the caller frees. */
enum spec_status spec_plan_check(struct spec_plan *plan);

/* Decides what the result is, and makes its header. */
enum spec_status spec_plan_result(struct spec_plan *plan);

/* Makes a program for each channel that is no copy of the first image's. */
enum spec_status spec_plan_channels(struct spec_plan *plan);

#endif
