/*
 * labial-bench-delay [-] - the latest frame of the demo's sentence, in milliseconds after its own time, or that of each
 * utterance of the standard input: a line each, of phonemes' numbers and milliseconds by turns.
 *
 * Time runs in ticks, one per frame period. A phoneme is pushed before the first tick that does not come before its
 * start, a pause with its whole duration as any other; the end is told when the last phoneme is over.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "inputs.h"

#define PHONEMES 1000u

typedef struct {
    unsigned phoneme;
    uint32_t ms;
} pushed_t;

static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static pushed_t phonemes[PHONEMES];

typedef struct {
    uint32_t tick, latest;
} clock_frames_t;

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    clock_frames_t *clock = (clock_frames_t *)user;
    (void)faps;
    if (clock->tick - frame > clock->latest)
        clock->latest = clock->tick - frame;
}

/* Plays the phonemes in real time; returns whether all was well. */
static int play(unsigned count, uint32_t *latest)
{
    const uint32_t period = 1000u / speech_en.frames_per_second;
    clock_frames_t clock = { 0, 0 };
    uint32_t start = 0;
    unsigned next = 0;
    int result = labial_init(&stream, &speech_en, workspace, sizeof workspace, on_frame, &clock);
    (void)labial_exact(&stream, 1);
    while (result >= 0 && result != LABIAL_DONE) {
        for (; next < count && start <= clock.tick * period && result >= 0; next++) {
            result = labial_push(&stream, phonemes[next].phoneme, phonemes[next].ms);
            start += phonemes[next].ms;
        }
        if (next == count && start <= clock.tick * period)
            labial_end(&stream);
        if (result >= 0)
            result = labial_tick(&stream);
        clock.tick++;
    }
    *latest = clock.latest * period;
    return result == LABIAL_DONE;
}

/* Reads a line; returns its phonemes, PHONEMES + 1 for one that cannot be used. */
static unsigned read_line(char *line)
{
    unsigned count = 0;
    char *at = line, *behind;
    for (;; count++) {
        const unsigned long phoneme = strtoul(at, &behind, 10);
        if (behind == at)
            break;
        at = behind;
        if (count == PHONEMES)
            return PHONEMES + 1u;
        phonemes[count].phoneme = (unsigned)phoneme;
        phonemes[count].ms = (uint32_t)strtoul(at, &behind, 10);
        if (behind == at)
            return PHONEMES + 1u;
        at = behind;
    }
    return at[strspn(at, " \n")] == '\0' ? count : PHONEMES + 1u;
}

static int play_sentence(void)
{
    const bench_input_t input = BENCH_SPEECH;
    uint32_t latest;
    for (unsigned i = 0; i < input.count; i++) {
        phonemes[i].phoneme = input.phonemes[i].phoneme;
        phonemes[i].ms = input.phonemes[i].ms;
    }
    if (!play(input.count, &latest))
        return 1;
    printf("%lu\n", (unsigned long)latest);
    return 0;
}

int main(int argc, char **argv)
{
    static char line[16384];
    uint32_t latest;
    if (argc == 1)
        return play_sentence();
    if (argc != 2 || strcmp(argv[1], "-") != 0) {
        fputs("usage: labial-bench-delay [-]\n", stderr);
        return 2;
    }
    while (fgets(line, sizeof line, stdin)) {
        const unsigned count = read_line(line);
        if (count > PHONEMES || !play(count, &latest)) {
            fputs("labial-bench-delay: malformed input\n", stderr);
            return 1;
        }
        printf("%lu\n", (unsigned long)latest);
    }
    return 0;
}
