/*
 * fixture_seed.c - what a test draws from, and its last seed, for what its failures print (suite.h).
 */
#include "fixture.h"

static struct {
    uint32_t last;
    unsigned long count;
} seeds;

fixture_random_t fixture_dice;

uint32_t fixture_seed(uint32_t seed)
{
    seeds.last = seed;
    seeds.count++;
    return seed;
}

uint32_t fixture_seed_last(void)
{
    return seeds.last;
}

unsigned long fixture_seed_count(void)
{
    return seeds.count;
}

void fixture_seed_forget(void)
{
    seeds.count = 0;
}
