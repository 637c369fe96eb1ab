/*
 * board_ticks.c - what the ticks of a board take at most, over inputs that a user may well have: prints for each input,
 * and for all of them, the mean, the 99th percentile and the largest of the instructions that a call of labial_tick()
 * takes, once frames are delivered. BENCH_SECONDS is how much of each input is synthesised.
 */
#include "board.h"
#include "inputs.h"

/* Six sentences as another synthesiser times them (export/labial/fit/sentences.flite). */
/* clang-format off */
#define S(label, ms) { SPEECH_EN_##label, ms }
static const bench_phoneme_t sentences[] = {
    S(SIL, 136), S(P, 98), S(EY, 111), S(P, 80), S(ER, 119), S(M, 69), S(AE, 139), S(P, 66), S(S, 155), S(SH, 143),
    S(OW, 186), S(EH, 99), S(V, 39), S(ER, 119), S(IY, 51), S(V, 54), S(AE, 156), S(L, 115), S(IY, 57), S(B, 80),
    S(IH, 85), S(T, 104), S(W, 124), S(IY, 122), S(N, 77), S(DH, 21), S(AH, 26), S(T, 133), S(UW, 68), S(R, 121),
    S(IH, 35), S(V, 47), S(ER, 213), S(Z, 159), S(SIL, 176), S(SIL, 142), S(M, 110), S(UW, 158), S(V, 39), S(DH, 52),
    S(AH, 41), S(B, 136), S(L, 127), S(UW, 100), S(B, 77), S(AA, 129), S(K, 128), S(S, 159), S(B, 79), S(IH, 69),
    S(S, 123), S(AY, 254), S(D, 50), S(DH, 56), S(AH, 29), S(W, 82), S(IH, 71), S(N, 44), S(D, 61), S(OW, 118),
    S(AE, 185), S(N, 69), S(D, 39), S(OW, 212), S(P, 110), S(AH, 43), S(N, 59), S(IH, 62), S(T, 44), S(AH, 96),
    S(P, 149), S(SIL, 182), S(SIL, 168), S(AH, 37), S(B, 86), S(AH, 120), S(V, 46), S(DH, 48), S(AH, 38), S(V, 92),
    S(IH, 55), S(L, 106), S(AH, 98), S(JH, 170), S(SIL, 110), S(F, 146), S(AY, 184), S(V, 58), S(HH, 26), S(Y, 103),
    S(UW, 58), S(JH, 125), S(B, 56), S(AH, 17), S(L, 116), S(UW, 119), S(N, 53), S(Z, 112), S(W, 81), S(ER, 84),
    S(F, 114), S(L, 84), S(OW, 121), S(T, 31), S(IH, 76), S(NG, 141), S(AH, 48), S(W, 142), S(EY, 224), S(SIL, 160),
    S(SIL, 177), S(AW, 143), S(ER, 122), S(P, 86), S(UH, 40), S(R, 78), S(P, 119), S(AH, 82), S(P, 80), S(IY, 90),
    S(JH, 125), S(AH, 98), S(M, 38), S(P, 83), S(T, 91), S(OW, 106), S(V, 64), S(ER, 114), S(DH, 82), S(AH, 59),
    S(P, 164), S(UW, 80), S(L, 194), S(AE, 123), S(N, 46), S(D, 21), S(F, 167), S(EH, 103), S(L, 88), S(IH, 31),
    S(N, 65), S(T, 69), S(UW, 77), S(DH, 59), S(AH, 38), S(M, 105), S(AH, 122), S(D, 78), S(SIL, 181), S(SIL, 174),
    S(IY, 117), S(CH, 172), S(AH, 147), S(V, 47), S(DH, 58), S(AH, 41), S(B, 104), S(OY, 319), S(Z, 79), S(SH, 124),
    S(OW, 153), S(D, 53), S(M, 48), S(IY, 202), S(HH, 79), S(AW, 170), S(T, 102), S(AH, 49), S(W, 91), S(IH, 51),
    S(S, 108), S(AH, 44), S(L, 82), S(TH, 128), S(R, 31), S(UW, 101), S(AH, 63), S(L, 130), S(IY, 109), S(F, 170),
    S(SIL, 183), S(SIL, 119), S(HH, 61), S(AW, 169), S(M, 61), S(AH, 83), S(CH, 126), S(W, 91), S(UH, 61), S(D, 53),
    S(W, 71), S(UH, 90), S(D, 62), S(Y, 171), S(UW, 37), S(P, 101), S(UH, 84), S(T, 69), S(IH, 83), S(N, 45),
    S(T, 69), S(UW, 35), S(DH, 52), S(IY, 89), S(AH, 93), S(V, 59), S(AH, 36), S(N, 101), S(B, 63), S(IH, 80),
    S(F, 160), S(AO, 108), S(R, 131), S(L, 131), S(AH, 138), S(N, 49), S(CH, 142), S(SIL, 194)
};
#undef S
/* clang-format on */

static const bench_input_t speech = BENCH_SPEECH, laughter = BENCH_LAUGHTER;

/* Instructions are counted in steps of so many; what is beyond the last counts there. */
enum { STEP = 50, STEPS = 800 };

typedef struct {
    uint16_t counts[STEPS];
    uint32_t ticks, total, largest;
} ticks_t;

typedef struct {
    const char *name;
    bench_phoneme_t (*next)(unsigned number, const labial_model_t **model);
} source_t;

static labial_t stream;
static uint32_t workspace[LABIAL_LARGER(SPEECH_EN_WORKSPACE_SIZE, LAUGHTER_SYNTHETIC_WORKSPACE_SIZE) / 4];
static uint32_t sum, drawn;
static ticks_t own, all;

static uint32_t draw(uint32_t limit)
{
    drawn = drawn * 1664525u + 1013904223u;
    return (drawn >> 16) % limit;
}

static bench_phoneme_t of(const bench_input_t *input, unsigned number)
{
    return input->phonemes[number % input->count];
}

static bench_phoneme_t sentence(unsigned number, const labial_model_t **model)
{
    *model = &speech_en;
    return of(&speech, number);
}

static bench_phoneme_t laugh(unsigned number, const labial_model_t **model)
{
    *model = &laughter_synthetic;
    return of(&laughter, number);
}

static bench_phoneme_t other_sentences(unsigned number, const labial_model_t **model)
{
    *model = &speech_en;
    return sentences[number % (sizeof sentences / sizeof *sentences)];
}

/* Any phonemes of 20 to 40 ms. */
static bench_phoneme_t short_phonemes(unsigned number, const labial_model_t **model)
{
    bench_phoneme_t phoneme;
    (void)number;
    *model = &speech_en;
    phoneme.phoneme = (uint8_t)draw(SPEECH_EN_PHONEMES);
    phoneme.ms = (uint16_t)(20u + draw(21));
    return phoneme;
}

/* Any phonemes of a frame each. */
static bench_phoneme_t single_frames(unsigned number, const labial_model_t **model)
{
    bench_phoneme_t phoneme = short_phonemes(number, model);
    phoneme.ms = 1000u / SPEECH_EN_FPS;
    return phoneme;
}

/* Both models by turns, which change every five phonemes; or with every phoneme. */
static bench_phoneme_t turns(unsigned number, const labial_model_t **model)
{
    const unsigned turn = number / BENCH_TURN, place = turn / 2u * BENCH_TURN + number % BENCH_TURN;
    const bench_input_t *const input = turn % 2u ? &laughter : &speech;
    *model = input->model;
    return of(input, place);
}

static bench_phoneme_t changes(unsigned number, const labial_model_t **model)
{
    const bench_input_t *const input = number % 2u ? &laughter : &speech;
    *model = input->model;
    return of(input, number / 2u);
}

static const source_t sources[] = {
    { "sentence", sentence },    { "laughter", laugh }, { "voices", other_sentences }, { "short", short_phonemes },
    { "frames", single_frames }, { "turns", turns },    { "changes", changes },
};

static void count(ticks_t *ticks, uint32_t taken)
{
    ticks->counts[taken / STEP < STEPS ? taken / STEP : STEPS - 1]++;
    ticks->ticks++;
    ticks->total += taken;
    ticks->largest = taken > ticks->largest ? taken : ticks->largest;
}

static void report(const char *name, const ticks_t *ticks)
{
    uint32_t above = ticks->ticks;
    unsigned step = 0;
    for (; step < STEPS && above > ticks->ticks / 100u; step++)
        above -= ticks->counts[step];
    board_print(name);
    board_print_within("_mean ", ticks->total / ticks->ticks, "\n");
    board_print(name);
    board_print_within("_99th ", step * STEP, "\n");
    board_print(name);
    board_print_within("_largest ", ticks->largest, "\n");
}

static int play(const source_t *source)
{
    uint32_t pushed = 0;
    unsigned number = 0;
    int result;
    for (unsigned i = 0; i < STEPS; i++)
        own.counts[i] = 0;
    own.ticks = own.total = own.largest = 0;
    drawn = 1;
    if (labial_init(&stream, &speech_en, workspace, sizeof workspace, bench_on_frame, &sum) != LABIAL_OK)
        return 1;
    do {
        uint32_t taken;
        while (pushed < BENCH_SECONDS * 1000u && labial_room(&stream) > 0) {
            const labial_model_t *model;
            const bench_phoneme_t phoneme = source->next(number, &model);
            if (labial_use(&stream, model) != LABIAL_OK) /* its frames are delivered first */
                break;
            if (labial_push(&stream, phoneme.phoneme, phoneme.ms) != LABIAL_OK)
                return 1;
            pushed += phoneme.ms;
            number++;
        }
        if (pushed >= BENCH_SECONDS * 1000u)
            labial_end(&stream);
        board_count_start();
        result = labial_tick(&stream);
        taken = board_count();
        if (taken == BOARD_COUNT_OVERFLOW)
            return 1;
        if (result == LABIAL_OK) {
            count(&own, taken);
            count(&all, taken);
        }
    } while (result >= 0 && result != LABIAL_DONE);
    report(source->name, &own);
    return result != LABIAL_DONE;
}

int main(void)
{
    for (unsigned i = 0; i < sizeof sources / sizeof *sources; i++)
        if (play(&sources[i]))
            return 1;
    report("all", &all);
    board_print_within("checksum ", sum, "\n");
    return 0;
}
