/*
 * servo.c - the jaw (lips.h): a timer reads the frame that is heard, and the LED controller makes the pulse.
 */
#include <driver/ledc.h>
#include <esp_timer.h>

#include "labial/face.h"
#include "lips.h"

#define PERIOD 20000 /* microseconds: of a frame and of a servo's pulses */
#define BITS LEDC_TIMER_14_BIT
#define TIMER LEDC_TIMER_3 /* the last of each, which boards use for their backlights last */
#define CHANNEL LEDC_CHANNEL_5

static const labial_rig_output_t jaw = LABIAL_RIG_SERVO(SERVO_CLOSED, SERVO_OPEN, SERVO_SLEW);
static const labial_rig_t rig = { &jaw, 1 };
static labial_face_t face;
static int32_t room[LABIAL_FACE_SIZE(1, 0) / 4];
static int32_t pulse;

static void move(void *user)
{
    int16_t faps[LABIAL_CHANNELS];
    (void)user;
    (void)lips_frame(esp_timer_get_time(), faps);
    labial_face_frame(&face, 0, faps);
    (void)labial_face_tick(&face, &pulse);
    (void)ledc_set_duty(LEDC_LOW_SPEED_MODE, CHANNEL, ((uint32_t)pulse << 14) / PERIOD);
    (void)ledc_update_duty(LEDC_LOW_SPEED_MODE, CHANNEL);
}

int servo_begin(int pin)
{
    ledc_timer_config_t timer = { 0 };
    ledc_channel_config_t channel = { 0 };
    esp_timer_create_args_t every = { 0 };
    esp_timer_handle_t handle;
    esp_err_t result;
    labial_rig_rest(&rig, &pulse); /* with the first pulse a servo goes there */
    (void)labial_face_init(&face, &rig, 1000000 / PERIOD, 0, room, sizeof room);
    timer.speed_mode = LEDC_LOW_SPEED_MODE;
    timer.duty_resolution = BITS;
    timer.timer_num = TIMER;
    timer.freq_hz = 1000000 / PERIOD;
    timer.clk_cfg = LEDC_AUTO_CLK;
    channel.gpio_num = pin;
    channel.speed_mode = LEDC_LOW_SPEED_MODE;
    channel.channel = CHANNEL;
    channel.timer_sel = TIMER;
    channel.duty = ((uint32_t)pulse << 14) / PERIOD;
    every.callback = move;
    every.name = "lips";
    if ((result = ledc_timer_config(&timer)) != ESP_OK || (result = ledc_channel_config(&channel)) != ESP_OK ||
        (result = esp_timer_create(&every, &handle)) != ESP_OK)
        return result;
    return esp_timer_start_periodic(handle, PERIOD);
}
