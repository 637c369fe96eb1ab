/*
 * esp32.h - as much of ESP-IDF and of the libraries beside it as examples/esp32-hear and examples/esp32-beside use, to
 * compile them on a host. The tests give it the names of all of these headers; esp32.c has what the calls do.
 */
#ifndef ESP32_STUB_H
#define ESP32_STUB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* esp_timer.h: ESP-IDF's esp_timer for compiling examples on a host: a clock that the test sets, one timer that it
 * calls. */
typedef int esp_err_t;
#define ESP_OK 0
typedef struct {
    void (*callback)(void *user);
    void *arg;
    const char *name;
} esp_timer_create_args_t;
typedef const esp_timer_create_args_t *esp_timer_handle_t;

int64_t esp_timer_get_time(void);
esp_err_t esp_timer_create(const esp_timer_create_args_t *args, esp_timer_handle_t *handle);
esp_err_t esp_timer_start_periodic(esp_timer_handle_t timer, uint64_t period);

/* driver/ledc.h: ESP-IDF's LED controller: the test sees the latest duty. */
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

/* freertos/FreeRTOS.h: FreeRTOS: critical sections are counted, so that one that is not left is found; a tick is a
 * millisecond. */
typedef uint32_t TickType_t;
typedef int BaseType_t;
#define pdTRUE 1
#define pdPASS 1
#define pdMS_TO_TICKS(ms) ((TickType_t)(ms))
#define portMAX_DELAY 0xffffffffu

typedef struct {
    int depth;
} portMUX_TYPE;
#define portMUX_INITIALIZER_UNLOCKED                                                                                   \
    {                                                                                                                  \
        0                                                                                                              \
    }
void stub_enter(portMUX_TYPE *mux);
void stub_exit(portMUX_TYPE *mux);
#define portENTER_CRITICAL(mux) stub_enter(mux)
#define portEXIT_CRITICAL(mux) stub_exit(mux)

/* freertos/task.h: FreeRTOS's tasks, which the test runs itself. */
typedef void *TaskHandle_t;
BaseType_t xTaskCreate(void (*task)(void *), const char *name, uint32_t stack, void *user, unsigned priority,
                       TaskHandle_t *handle);
void vTaskDelay(TickType_t ticks);

/* freertos/stream_buffer.h: FreeRTOS's stream buffers. A receive that would wait returns nothing, unless stub_timeout
 * says that it has waited long enough. */
typedef struct stub_buffer *StreamBufferHandle_t;
StreamBufferHandle_t xStreamBufferCreate(size_t size, size_t trigger);
BaseType_t xStreamBufferSetTriggerLevel(StreamBufferHandle_t buffer, size_t trigger);
size_t xStreamBufferSend(StreamBufferHandle_t buffer, const void *data, size_t size, TickType_t wait);
size_t xStreamBufferReceive(StreamBufferHandle_t buffer, void *data, size_t size, TickType_t wait);

/* audio_render.h: the renderers of Espressif's av_render. */
typedef struct {
    uint8_t channel, bits_per_sample;
    uint32_t sample_rate;
} av_render_audio_frame_info_t;
typedef struct {
    uint32_t pts;
    uint8_t *data;
    int size;
    bool eos;
} av_render_audio_frame_t;

typedef void *audio_render_handle_t;
typedef struct {
    audio_render_handle_t (*init)(void *cfg, int cfg_size);
    int (*open)(audio_render_handle_t render, av_render_audio_frame_info_t *info);
    int (*write)(audio_render_handle_t render, av_render_audio_frame_t *audio_data);
    int (*get_latency)(audio_render_handle_t render, uint32_t *latency);
    int (*get_frame_info)(audio_render_handle_t render, av_render_audio_frame_info_t *info);
    int (*set_speed)(audio_render_handle_t render, float speed);
    int (*close)(audio_render_handle_t render);
    void (*deinit)(audio_render_handle_t render);
} audio_render_ops_t;
typedef struct {
    audio_render_ops_t ops;
    void *cfg;
    int cfg_size;
} audio_render_cfg_t;

audio_render_handle_t audio_render_alloc_handle(audio_render_cfg_t *cfg);
int audio_render_open(audio_render_handle_t render, av_render_audio_frame_info_t *info);
int audio_render_write(audio_render_handle_t render, av_render_audio_frame_t *audio_data);
int audio_render_get_latency(audio_render_handle_t render, uint32_t *latency);
int audio_render_set_speed(audio_render_handle_t render, float speed);
int audio_render_get_frame_info(audio_render_handle_t render, av_render_audio_frame_info_t *info);
int audio_render_close(audio_render_handle_t render);
void audio_render_free_handle(audio_render_handle_t render);

/* cJSON.h: cJSON: what the patched lines read. */
typedef struct {
    char *valuestring;
} cJSON;

cJSON *cJSON_GetObjectItem(const cJSON *object, const char *name);
int cJSON_IsString(const cJSON *item);

/* mbedtls/base64.h: Mbed TLS: its decoder of base64. */
int mbedtls_base64_decode(unsigned char *to, size_t room, size_t *size, const unsigned char *from, size_t length);

#ifdef __cplusplus
}
#endif

#endif
