/*
 * esp32.c - what the calls of esp32.h do on a host. The test that loads it reads and sets the variables.
 */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "esp32.h"

int64_t stub_now;
uint32_t stub_duty, stub_duties; /* that takes effect, and how often one did */
int stub_timeout, stub_tasks, stub_delays;
unsigned char stub_played[1 << 20]; /* by the renderer behind */
size_t stub_played_size;
int stub_opened;

/* ---- Time and servo ------------------------------------------------------------------------------------------ */

static esp_timer_create_args_t timer;
static uint64_t timer_period;
static uint32_t duty;

int64_t esp_timer_get_time(void)
{
    return stub_now;
}

esp_err_t esp_timer_create(const esp_timer_create_args_t *args, esp_timer_handle_t *handle)
{
    timer = *args;
    *handle = &timer;
    return ESP_OK;
}

esp_err_t esp_timer_start_periodic(esp_timer_handle_t handle, uint64_t period)
{
    assert(handle == &timer);
    timer_period = period;
    return ESP_OK;
}

uint64_t stub_timer(void) /* runs it once; its period */
{
    timer.callback(timer.arg);
    return timer_period;
}

esp_err_t ledc_timer_config(const ledc_timer_config_t *config)
{
    return config->freq_hz == 50 && config->duty_resolution == 14 ? ESP_OK : -1;
}

esp_err_t ledc_channel_config(const ledc_channel_config_t *config)
{
    stub_duty = config->duty;
    return config->gpio_num >= 0 ? ESP_OK : -1;
}

esp_err_t ledc_set_duty(int mode, int channel, uint32_t value)
{
    (void)mode, (void)channel;
    duty = value;
    return ESP_OK;
}

esp_err_t ledc_update_duty(int mode, int channel)
{
    (void)mode, (void)channel;
    stub_duty = duty;
    stub_duties++;
    return ESP_OK;
}

/* ---- FreeRTOS ------------------------------------------------------------------------------------------------ */

void stub_enter(portMUX_TYPE *mux)
{
    assert(mux->depth == 0);
    mux->depth = 1;
}

void stub_exit(portMUX_TYPE *mux)
{
    assert(mux->depth == 1);
    mux->depth = 0;
}

BaseType_t xTaskCreate(void (*task)(void *), const char *name, uint32_t stack, void *user, unsigned priority,
                       TaskHandle_t *handle)
{
    (void)name, (void)stack, (void)user, (void)priority, (void)handle;
    stub_tasks += task != NULL;
    return pdPASS;
}

void lips_render_step(void);

void vTaskDelay(TickType_t ticks) /* in which the other task runs */
{
    (void)ticks;
    assert(++stub_delays < 1000);
    stub_timeout = 1;
    lips_render_step();
    stub_timeout = 0;
}

struct stub_buffer {
    size_t size, trigger, filled;
    int waits; /* was found empty */
    unsigned char bytes[1 << 17];
};

StreamBufferHandle_t xStreamBufferCreate(size_t size, size_t trigger)
{
    static struct stub_buffer buffer;
    assert(size <= sizeof buffer.bytes);
    memset(&buffer, 0, sizeof buffer);
    buffer.size = size;
    buffer.trigger = trigger;
    buffer.waits = 1;
    return &buffer;
}

BaseType_t xStreamBufferSetTriggerLevel(StreamBufferHandle_t buffer, size_t trigger)
{
    buffer->trigger = trigger;
    return trigger <= buffer->size;
}

size_t xStreamBufferSend(StreamBufferHandle_t buffer, const void *data, size_t size, TickType_t wait)
{
    assert(wait == portMAX_DELAY && buffer->filled + size <= buffer->size);
    memcpy(buffer->bytes + buffer->filled, data, size);
    buffer->filled += size;
    return size;
}

size_t xStreamBufferReceive(StreamBufferHandle_t buffer, void *data, size_t size, TickType_t wait)
{
    assert(wait > 0 && wait < portMAX_DELAY);
    if (buffer->waits && buffer->filled < buffer->trigger && !stub_timeout)
        return 0;
    const size_t got = buffer->filled < size ? buffer->filled : size;
    memcpy(data, buffer->bytes, got);
    buffer->filled -= got;
    memmove(buffer->bytes, buffer->bytes + got, buffer->filled);
    buffer->waits = buffer->filled == 0;
    return got;
}

/* ---- av_render: a renderer behind, the handle 1, and one in front of it -------------------------------------- */

static audio_render_ops_t front;
static av_render_audio_frame_info_t format;

audio_render_handle_t audio_render_alloc_handle(audio_render_cfg_t *cfg)
{
    front = cfg->ops;
    return front.init(cfg->cfg, cfg->cfg_size);
}

int audio_render_open(audio_render_handle_t render, av_render_audio_frame_info_t *info)
{
    assert(render == (void *)1);
    format = *info;
    stub_opened = 1;
    return 0;
}

int audio_render_write(audio_render_handle_t render, av_render_audio_frame_t *audio_data)
{
    assert(render == (void *)1 && stub_opened && stub_played_size + (size_t)audio_data->size <= sizeof stub_played);
    memcpy(stub_played + stub_played_size, audio_data->data, (size_t)audio_data->size);
    stub_played_size += (size_t)audio_data->size;
    return 0;
}

int audio_render_get_latency(audio_render_handle_t render, uint32_t *latency)
{
    (void)render;
    *latency = 7;
    return 0;
}

int audio_render_set_speed(audio_render_handle_t render, float speed)
{
    (void)render, (void)speed;
    return 0;
}

int audio_render_get_frame_info(audio_render_handle_t render, av_render_audio_frame_info_t *info)
{
    (void)render;
    *info = format;
    return 0;
}

int audio_render_close(audio_render_handle_t render)
{
    (void)render;
    stub_opened = 0;
    return 0;
}

void audio_render_free_handle(audio_render_handle_t render)
{
    (void)render;
}

int stub_open(uint32_t rate, unsigned channels, unsigned bits)
{
    av_render_audio_frame_info_t info = { 0 };
    info.channel = (uint8_t)channels;
    info.bits_per_sample = (uint8_t)bits;
    info.sample_rate = rate;
    return front.open((void *)1, &info);
}

int stub_write(unsigned char *data, int size)
{
    av_render_audio_frame_t frame = { 0 };
    frame.data = data;
    frame.size = size;
    return front.write((void *)1, &frame);
}

uint32_t stub_latency(void)
{
    uint32_t latency = 0;
    return front.get_latency((void *)1, &latency) == 0 ? latency : 0;
}

int stub_close(void)
{
    return front.close((void *)1);
}
