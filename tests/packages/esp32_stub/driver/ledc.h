/* Stub of ESP-IDF's LED controller: the test sees the latest duty. */
#ifndef LEDC_H
#define LEDC_H

#include <stdint.h>

#include "esp_timer.h"

enum { LEDC_LOW_SPEED_MODE, LEDC_TIMER_3 = 3, LEDC_CHANNEL_5 = 5, LEDC_TIMER_14_BIT = 14, LEDC_AUTO_CLK = 0 };
typedef struct {
    int speed_mode, duty_resolution, timer_num;
    uint32_t freq_hz;
    int clk_cfg;
} ledc_timer_config_t;
typedef struct {
    int gpio_num, speed_mode, channel, timer_sel;
    uint32_t duty;
} ledc_channel_config_t;

esp_err_t ledc_timer_config(const ledc_timer_config_t *config);
esp_err_t ledc_channel_config(const ledc_channel_config_t *config);
esp_err_t ledc_set_duty(int mode, int channel, uint32_t duty);
esp_err_t ledc_update_duty(int mode, int channel);

#endif
