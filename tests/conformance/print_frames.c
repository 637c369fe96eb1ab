/*
 * print_frames.c - prints every stream's frames: a line with its name, then a line per frame.
 */
#include "board.h"
#include "player.h"

static labial_t stream;
static uint32_t workspace[CONFORMANCE_WORKSPACE / 4];

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    (void)user;
    (void)frame;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++) {
        board_print_signed(faps[k]);
        board_put(k + 1u < LABIAL_CHANNELS ? ' ' : '\n');
    }
}

int main(void)
{
    for (unsigned i = 0; i < conformance_stream_count; i++) {
        const char *complaint;
        board_print(conformance_streams[i].name);
        board_put('\n');
        complaint = conformance_play(&conformance_streams[i], CONFORMANCE_FILL, &stream, workspace, sizeof workspace,
                                     on_frame, 0);
        if (complaint) {
            board_print(complaint);
            return 1;
        }
    }
    return 0;
}
