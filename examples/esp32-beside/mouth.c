/*
 * mouth.c - the loudspeaker's clock, and a servo, for labial/beside.h.
 */
#include "mouth.h"

#include <driver/ledc.h>
#include <esp_timer.h>
#include <freertos/FreeRTOS.h>

#include "labial/beside.h"
#include "labial/clock.h"

#define PERIOD 20000 /* microseconds: of a frame and of a servo's pulses */
#define TIMER LEDC_TIMER_3
#define CHANNEL LEDC_CHANNEL_5

static portMUX_TYPE guard = portMUX_INITIALIZER_UNLOCKED;

/* Shared. */
static labial_beside_t lips;
static uint8_t memory[LABIAL_BESIDE_SIZE(MOUTH_OUTPUTS, MOUTH_FRAMES)];
static labial_clock_t loudspeaker;
static int64_t received; /* samples so far */

int mouth_begin(uint32_t samples_per_second)
{
    int result;
    portENTER_CRITICAL(&guard);
    result = labial_beside_restart(&lips, samples_per_second);
    if (result == LABIAL_ERROR_STATE) { /* the first one */
        result = labial_beside_init(&lips, MOUTH_OUTPUTS, samples_per_second, memory, sizeof memory);
        (void)labial_beside_limit(&lips, 0, LABIAL_BESIDE_CHANGE(MOUTH_CHANGE, MOUTH_AT_0, MOUTH_AT_255));
    }
    if (labial_clock_init(&loudspeaker, result < 0 ? 0 : samples_per_second) < 0 && result >= 0)
        result = LABIAL_ERROR_SAMPLE_RATE;
    received = 0;
    portEXIT_CRITICAL(&guard);
    return result;
}

int mouth_packet(const void *packet, size_t size)
{
    int result;
    portENTER_CRITICAL(&guard);
    result = labial_beside_push(&lips, packet, size);
    portEXIT_CRITICAL(&guard);
    return result;
}

int64_t mouth_receive(size_t count)
{
    int64_t number;
    portENTER_CRITICAL(&guard);
    number = received;
    received += (int64_t)count;
    portEXIT_CRITICAL(&guard);
    return number;
}

void mouth_playing(int64_t number, size_t count, int64_t now)
{
    portENTER_CRITICAL(&guard);
    labial_clock_play(&loudspeaker, number, (uint32_t)count, now);
    portEXIT_CRITICAL(&guard);
}

void mouth_cancel(void)
{
    portENTER_CRITICAL(&guard);
    (void)labial_beside_cancel(&lips, MOUTH_EASE);
    labial_clock_stop(&loudspeaker);
    portEXIT_CRITICAL(&guard);
}

int mouth_values(int64_t now, uint8_t values[MOUTH_OUTPUTS])
{
    int64_t sample;
    int result;
    portENTER_CRITICAL(&guard);
    (void)labial_clock_at(&loudspeaker, now, &sample);
    result = labial_beside_tick(&lips, (uint32_t)sample, values);
    portEXIT_CRITICAL(&guard);
    return result;
}

static void move(void *user)
{
    uint8_t values[MOUTH_OUTPUTS];
    (void)user;
    if (mouth_values(esp_timer_get_time(), values) >= 0) {
        const int32_t pulse = labial_beside_value(values[0], MOUTH_AT_0, MOUTH_AT_255);
        (void)ledc_set_duty(LEDC_LOW_SPEED_MODE, CHANNEL, ((uint32_t)pulse << 14) / PERIOD);
        (void)ledc_update_duty(LEDC_LOW_SPEED_MODE, CHANNEL);
    }
}

int mouth_servo(int pin)
{
    ledc_timer_config_t timer = { 0 };
    ledc_channel_config_t channel = { 0 };
    esp_timer_create_args_t every = { 0 };
    esp_timer_handle_t handle;
    esp_err_t result;
    timer.speed_mode = LEDC_LOW_SPEED_MODE;
    timer.duty_resolution = LEDC_TIMER_14_BIT;
    timer.timer_num = TIMER;
    timer.freq_hz = 1000000 / PERIOD;
    timer.clk_cfg = LEDC_AUTO_CLK;
    channel.gpio_num = pin;
    channel.speed_mode = LEDC_LOW_SPEED_MODE;
    channel.channel = CHANNEL;
    channel.timer_sel = TIMER; /* no pulse until the face at rest is known */
    every.callback = move;
    every.name = "mouth";
    if ((result = ledc_timer_config(&timer)) != ESP_OK || (result = ledc_channel_config(&channel)) != ESP_OK ||
        (result = esp_timer_create(&every, &handle)) != ESP_OK)
        return result;
    return esp_timer_start_periodic(handle, PERIOD);
}
