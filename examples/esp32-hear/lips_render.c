/*
 * lips_render.c - the stream buffer between the thread that decodes and the task that plays.
 */
#include "lips_render.h"

#include <esp_timer.h>
#include <freertos/FreeRTOS.h>
#include <freertos/stream_buffer.h>
#include <freertos/task.h>

#include "lips.h"

#define PIECE 2048 /* bytes that are played at once */
#define STACK 4096
#define PRIORITY 20 /* above the thread that decodes */

static audio_render_handle_t player;
static StreamBufferHandle_t waiting;
static size_t sample_bytes; /* of all channels */
static uint64_t played;
static volatile uint32_t sent, done; /* bytes into the buffer, and bytes that are played */

void lips_render_step(void)
{
    static uint8_t piece[PIECE];
    /* Returns what there is; after a pause only when the delay's worth has come, or no more comes. */
    const size_t bytes = xStreamBufferReceive(waiting, piece, PIECE, pdMS_TO_TICKS(2 * LIPS_RENDER_DELAY));
    if (bytes == 0)
        return;
    av_render_audio_frame_t frame = { 0 };
    frame.data = piece;
    frame.size = (int)bytes;
    lips_playing(played, bytes / sample_bytes, esp_timer_get_time());
    (void)audio_render_write(player, &frame);
    played += bytes / sample_bytes;
    done += (uint32_t)bytes;
}

static void task(void *user)
{
    (void)user;
    for (;;)
        lips_render_step();
}

/* ---- What av_render calls ---------------------------------------------------------------------------------------- */

static audio_render_handle_t render_init(void *to, int size)
{
    (void)size;
    player = to;
    waiting = xStreamBufferCreate(2 * LIPS_RENDER_DELAY * LIPS_RENDER_BYTES, 1);
    if (!waiting || xTaskCreate(task, "lips", STACK, NULL, PRIORITY, NULL) != pdPASS)
        return NULL;
    return to;
}

static int render_open(audio_render_handle_t render, av_render_audio_frame_info_t *info)
{
    const int result = audio_render_open(render, info);
    if (result != 0 || info->bits_per_sample != 16 || lips_begin(info->sample_rate, info->channel) != 0)
        return result != 0 ? result : -1;
    played = 0;
    sample_bytes = 2u * info->channel;
    const size_t delay = info->sample_rate * sample_bytes * LIPS_RENDER_DELAY / 1000;
    return delay <= LIPS_RENDER_DELAY * LIPS_RENDER_BYTES && xStreamBufferSetTriggerLevel(waiting, delay) == pdTRUE
               ? 0
               : -1;
}

static int render_write(audio_render_handle_t render, av_render_audio_frame_t *sound)
{
    (void)render;
    const size_t bytes = sound->size > 0 ? (size_t)sound->size / sample_bytes * sample_bytes : 0;
    (void)lips_feed(sound->data, bytes / sample_bytes);
    sent += (uint32_t)bytes;
    if (bytes > 0)
        (void)xStreamBufferSend(waiting, sound->data, bytes, portMAX_DELAY);
    return 0;
}

static int render_get_latency(audio_render_handle_t render, uint32_t *latency)
{
    const int result = audio_render_get_latency(render, latency);
    if (result == 0)
        *latency += LIPS_RENDER_DELAY;
    return result;
}

static int render_close(audio_render_handle_t render)
{
    while (done != sent)
        vTaskDelay(1);
    lips_cancel();
    return audio_render_close(render);
}

audio_render_handle_t lips_render(audio_render_handle_t to)
{
    audio_render_cfg_t cfg = { 0 };
    if (!to)
        return NULL;
    cfg.ops.init = render_init;
    cfg.ops.open = render_open;
    cfg.ops.write = render_write;
    cfg.ops.get_latency = render_get_latency;
    cfg.ops.get_frame_info = audio_render_get_frame_info;
    cfg.ops.set_speed = audio_render_set_speed;
    cfg.ops.close = render_close;
    cfg.ops.deinit = audio_render_free_handle;
    cfg.cfg = to;
    cfg.cfg_size = sizeof to;
    return audio_render_alloc_handle(&cfg);
}
