/*
 * print_frames.c - prints every stream's frames, as frames.txt holds them: a line with its name, then a line per frame, or
 * for those that are like the one before `and` and how many they are.
 */
#include <string.h>

#include "board.h"
#include "player.h"

static labial_t stream;
static uint32_t workspace[CONFORMANCE_WORKSPACE / 4];

static int16_t last[LABIAL_CHANNELS];
static uint32_t printed, alike;

static void print_alike(void)
{
    if (alike)
        board_print_within("and ", alike, "\n");
    alike = 0;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    unsigned k;
    (void)user;
    (void)frame;
    if (printed && memcmp(last, faps, sizeof last) == 0) {
        alike++;
        return;
    }
    print_alike();
    memcpy(last, faps, sizeof last);
    printed++;
    for (k = 0; k < LABIAL_CHANNELS; k++) {
        board_print_signed(faps[k]);
        board_put(k + 1u < LABIAL_CHANNELS ? ' ' : '\n');
    }
}

int main(void)
{
    unsigned i;
    for (i = 0; i < conformance_stream_count; i++) {
        const char *complaint;
        board_print(conformance_streams[i].name);
        board_put('\n');
        printed = 0;
        complaint = conformance_play(&conformance_streams[i], CONFORMANCE_FILL, &stream, workspace, sizeof workspace,
                                     on_frame, 0);
        print_alike();
        if (complaint) {
            board_print(complaint);
            board_put('\n');
            return 1;
        }
    }
    return 0;
}
