/*
 * labial-bench speech|laughter SECONDS - synthesises that much motion and says how long it took.
 *
 * Under callgrind,
 *     valgrind --tool=callgrind --toggle-collect=labial_tick labial-bench speech 20
 * divides into instructions per frame, which do not depend on the machine's load.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "inputs.h"

static const bench_input_t speech = BENCH_INPUT(SPEECH);
static const bench_input_t laughter = BENCH_INPUT(LAUGHTER);

static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_SEARCH_STRIDE_MAX, LABIAL_CHANNELS) / 4];

int main(int argc, char **argv)
{
    const bench_input_t *input = NULL;
    const long seconds = argc == 3 ? atol(argv[2]) : 0;
    unsigned long frames = 0;
    uint32_t sum = 0, pushed = 0;
    unsigned next = 0;
    clock_t start;
    double taken;
    int result;

    if (argc == 3 && strcmp(argv[1], "speech") == 0)
        input = &speech;
    else if (argc == 3 && strcmp(argv[1], "laughter") == 0)
        input = &laughter;
    if (!input || seconds <= 0 || seconds > 1000000) {
        fputs("usage: labial-bench speech|laughter SECONDS\n", stderr);
        return 2;
    }
    if (labial_init(&stream, input->model, workspace, sizeof workspace, bench_on_frame, &sum) != LABIAL_OK)
        return 1;
    (void)labial_exact(&stream, 1);
    start = clock();
    do {
        bench_feed(&stream, input, &next, &pushed, (uint32_t)seconds * 1000u);
        result = labial_tick(&stream);
        frames += result == LABIAL_OK;
    } while (result >= 0 && result != LABIAL_DONE);
    taken = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (result < 0)
        return 1;
    printf("%lu frames in %.3f s: %.0f frames/s, %.0f times real time (checksum %08lx)\n", frames, taken,
           (double)frames / taken, (double)frames / taken / input->model->frames_per_second, (unsigned long)sum);
    return 0;
}
