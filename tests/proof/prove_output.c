/*
 * stream.c, one frame out: any motion due or none, at any step of a way to it or to rest, with every stride. fade.c is proven
 * on its own; its stand-in here leads anywhere.
 */
#include "any_fade.h"
#include "stream.c"
#include "stream_channels.h"

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int16_t *sum = (int16_t *)user;
    for (unsigned k = 0; k < LABIAL_CHANNELS; k++)
        *sum = (int16_t)(*sum ^ faps[k] ^ (int16_t)frame);
}

static void any_stream(labial_t *stream, int16_t *user)
{
    FILL(stream->fade.pose);
    stream->fade.step = any_uint16;
    stream->fade.length = any_uint16;
    stream->begun = (uint8_t)Frama_C_interval(0, 1);
    stream->exact = (uint8_t)Frama_C_interval(0, 1);
    stream->resting = (uint8_t)Frama_C_interval(0, 1);
    stream->held = (uint8_t)Frama_C_interval(0, LABIAL_HOLD_TICKS);
    FILL(stream->begins);
    FILL(stream->touches);
    stream->frame = any_uint32;
    stream->pending = any_uint32;
    stream->callback = on_frame;
    stream->user = user;
}

static void deliver_one(int stride)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    stream.channels.stride = (uint8_t)stride;
    stream.channels.entered = any_uint8;
    deliver(&stream);
}

static void call_back_one(void)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    call_back(&stream, (unsigned)Frama_C_interval(0, 1));
}

static void rest_one(void)
{
    labial_t stream;
    int16_t user = 0;
    any_stream(&stream, &user);
    rest(&stream);
    any_stream(&stream, &user);
    hold_or_rest(&stream);
}

int main(void)
{
    for (int stride = 1; stride <= LABIAL_SEARCH_STRIDE_MAX; stride++)
        deliver_one(stride);
    rest_one();
    call_back_one();
    return 0;
}
