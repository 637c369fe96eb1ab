/*
 * Any states of any model, any target, and a search that goes on from wherever a step may leave it. Models with fewer
 * states than a window has are taken one by one, with tables that end with the last state.
 */
#include "any_model.h"
#include "viterbi.h"

static void search_among(int least, int most)
{
    labial_model_t model;
    labial_search_t search;
    any_model(&model, 1);
    model.state_count = (uint8_t)Frama_C_interval(least, most);
    channels[0].emissions = emissions + LABIAL_STATES_MAX - most;
    FILL(search);
    labial_viterbi_step(&model, &channels[0], any_position(), LABIAL_BEGINS, &search);
    while (any_int) {
        labial_viterbi_step(&model, &channels[0], any_position(), any_unsigned, &search);
        labial_viterbi_span(&search, any_unsigned);
        labial_viterbi_state(&search, 0);
    }
}

int main(void)
{
    int count;
    for (count = 1; count < LABIAL_SEARCHED; count++)
        search_among(count, count);
    search_among(LABIAL_SEARCHED, LABIAL_STATES_MAX);
    return 0;
}
