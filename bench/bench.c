/*
 * labial-bench speech|laughter SECONDS - synthesises that much motion and says how long it took.
 *
 * The input is the phonemes of the demo's sentence, or two trains of laughter, over and over. Under callgrind,
 *     valgrind --tool=callgrind --toggle-collect=labial_tick labial-bench speech 20
 * divides into instructions per frame, which do not depend on the machine's load.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "laughter_synthetic.h"
#include "speech_en.h"

typedef struct {
    uint8_t phoneme;
    uint16_t ms;
} timing_t;

#define S(label, ms) { SPEECH_EN_##label, ms }
#define L(label, ms) { LAUGHTER_SYNTHETIC_##label, ms }

static const timing_t sentence[] = {
    S(SIL, 220), S(M, 71),  S(AY, 152), S(B, 90),  S(EY, 197), S(B, 85),   S(IY, 89),  S(M, 80),  S(EY, 139), S(B, 84),
    S(IY, 110),  S(HH, 92), S(AE, 106), S(P, 127), S(IY, 192), S(SIL, 220), S(W, 53),   S(EH, 70), S(R, 43),   S(W, 47),
    S(ER, 66),   S(Y, 84),  S(UW, 115), S(F, 112), S(AY, 155), S(V, 45),   S(Y, 63),   S(IH, 85), S(R, 73),   S(Z, 70),
    S(AH, 60),   S(G, 122), S(OW, 204), S(SIL, 220)
};

static const timing_t laugh[] = {
    L(FRICATIVE, 110), L(A, 104), L(FRICATIVE, 112), L(A, 100), L(FRICATIVE, 114), L(A, 90),  L(FRICATIVE, 122), L(E, 84),
    L(FRICATIVE, 120), L(CACKLE, 48), L(SILENCE, 180), L(NE, 240), L(FRICATIVE, 120), L(E, 92), L(FRICATIVE, 118), L(IC, 80),
    L(NASAL, 80),      L(SILENCE, 200)
};

static labial_t stream;
static uint32_t workspace[LABIAL_WORKSPACE_SIZE(LABIAL_STATES_MAX) / 4];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    uint32_t *sum = (uint32_t *)user;
    (void)frame;
    *sum = *sum * 31u + (uint32_t)(uint16_t)faps[0]; /* so that nothing is left out as unused */
}

int main(int argc, char **argv)
{
    const int speech = argc == 3 && strcmp(argv[1], "speech") == 0;
    const long seconds = argc == 3 ? atol(argv[2]) : 0;
    const labial_model_t *model = speech ? &speech_en : &laughter_synthetic;
    const timing_t *input = speech ? sentence : laugh;
    const size_t count = speech ? sizeof sentence / sizeof *sentence : sizeof laugh / sizeof *laugh;
    unsigned long pushed = 0, frames = 0;
    uint32_t sum = 0;
    size_t next = 0;
    clock_t start;
    double taken;
    int result;

    if (seconds <= 0 || (!speech && strcmp(argv[1], "laughter") != 0)) {
        fputs("usage: labial-bench speech|laughter SECONDS\n", stderr);
        return 2;
    }
    if (labial_init(&stream, model, workspace, sizeof workspace, on_frame, &sum) != LABIAL_OK)
        return 1;
    start = clock();
    do {
        while (pushed < (unsigned long)seconds * 1000ul && labial_room(&stream) > 0) {
            labial_push(&stream, input[next].phoneme, input[next].ms);
            pushed += input[next].ms;
            next = (next + 1u) % count;
        }
        if (pushed >= (unsigned long)seconds * 1000ul)
            labial_end(&stream);
        result = labial_tick(&stream);
        frames += result == LABIAL_OK;
    } while (result != LABIAL_DONE);
    taken = (double)(clock() - start) / CLOCKS_PER_SEC;
    printf("%lu frames in %.3f s: %.0f frames/s, %.0f times real time (checksum %08lx)\n", frames, taken,
           (double)frames / taken, (double)frames / taken / model->frames_per_second, (unsigned long)sum);
    return 0;
}
