/*
 * labial-bench-solve speech|laughter - the library's equation 3 for units that a program hands it, to hold against an
 * exact solution. Reads units from its standard input until that ends and writes their trajectories:
 *
 *   in    frames, uint16; for every channel `frames` states, uint8, and `frames` targets, int16, positions
 *   out   for every channel `frames` positions, int16
 *
 * in the machine's byte order.
 */
#include <stdio.h>
#include <string.h>

#include "labial/labial.h"
#include "laughter_synthetic.h"
#include "speech_en.h"
#include "unit.h"

static uint8_t path[BENCH_SOLVE];
static int16_t line[BENCH_SOLVE];

/* One channel; false when the input ends early. */
static int solve(const labial_model_t *model, unsigned k, unsigned frames)
{
    if (fread(path, 1, frames, stdin) != frames || fread(line, sizeof *line, frames, stdin) != frames)
        return 0;
    for (unsigned t = 0; t < frames; t++)
        if (path[t] >= model->state_count)
            return 0;
    bench_solve(model, k, path, frames, line);
    return fwrite(line, sizeof *line, frames, stdout) == frames;
}

int main(int argc, char **argv)
{
    const labial_model_t *model = NULL;
    uint16_t frames;
    if (argc == 2 && strcmp(argv[1], "speech") == 0)
        model = &speech_en;
    else if (argc == 2 && strcmp(argv[1], "laughter") == 0)
        model = &laughter_synthetic;
    if (!model) {
        fputs("usage: labial-bench-solve speech|laughter\n", stderr);
        return 2;
    }
    while (fread(&frames, sizeof frames, 1, stdin) == 1) {
        if (frames < 1 || frames > BENCH_SOLVE) {
            fprintf(stderr, "labial-bench-solve: a unit of %u frames\n", frames);
            return 1;
        }
        for (unsigned k = 0; k < model->channel_count; k++)
            if (!solve(model, k, frames)) {
                fputs("labial-bench-solve: malformed input\n", stderr);
                return 1;
            }
    }
    return 0;
}
