/* Stub of ESP-IDF's esp_timer for compiling examples on a host: a clock that the test sets, one timer that it calls. */
#ifndef ESP_TIMER_H
#define ESP_TIMER_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif

#endif
