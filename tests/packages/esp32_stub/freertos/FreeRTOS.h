/* Stub of FreeRTOS: critical sections are counted, so that one that is not left is found; a tick is a millisecond. */
#ifndef FREERTOS_H
#define FREERTOS_H

#include <stddef.h>
#include <stdint.h>

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

#endif
