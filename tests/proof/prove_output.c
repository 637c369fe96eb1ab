/*
 * stream.c, one frame out: any motion and any pose, at every step of a fade, with every stride; and every step of easing over every
 * number of frames.
 */
#include "prove.h"
#include "stream.c"
#include "stream_channels.h"

/* In the place of fixed.c, which does the same bit by bit (tests/c/test_fixed.c). */
uint32_t labial_quotient(uint32_t a, uint32_t b)
{
    return a / b;
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t *sum = (int16_t *)user;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        *sum = (int16_t)(*sum ^ faps[k] ^ (int16_t)frame);
}

static void any_stream(labial_t *stream, int16_t *user)
{
    FILL(stream->pose);
    FILL(stream->earlier);
    FILL(stream->faded);
    stream->begun = (uint8_t)Frama_C_interval(0, 1);
    stream->shown = (uint8_t)Frama_C_interval(0, 1);
    FILL(stream->begins);
    stream->frame = any_uint32;
    stream->pending = any_uint32;
    stream->callback = on_frame;
    stream->user = user;
}

static void deliver_one(int stride, int step)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    stream.channels.stride = (uint8_t)stride;
    stream.channels.entered = any_uint8;
    stream.fade_step = (uint8_t)step;
    deliver(&stream);
}

/* Over `least` to `most` frames. */
static void ease_one(int least, int most)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    stream.ease_length = (uint16_t)Frama_C_interval(least, most);
    stream.ease_step = (uint16_t)Frama_C_interval(0, most);
    eased(&stream, stream.pose);
    stream.ease_step = (uint16_t)Frama_C_interval(0, most - 1);
    ease(&stream);
}

int main(void)
{
    for (int stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++)
        for (int i = 0; i <= 8; i++)
            deliver_one(stride, i);
    /* In groups so small that EVA, which sees a step and a number of frames apart, sees how far their quotient goes. */
    /*@ loop unroll 40; */
    for (int i = 1; i <= 1000; i = i + i / 4 + 1)
        ease_one(i, i + i / 4);
    return 0;
}
