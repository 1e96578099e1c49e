/*
 * Every tool takes the light of places and times by name. A library should do nothing before
 * main begins, so this stands here and is linked to the tools alone.
 */
#include "place/sunlight.h"
#include "spectrum/lookup.h"

__attribute__((constructor)) static void
know_sunlight(void)
{
	spec_lookup_set_maker(&spec_sunlight_maker);
}
