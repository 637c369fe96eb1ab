/* Stub of FreeRTOS's tasks, which the test runs itself. */
#ifndef TASK_H
#define TASK_H

#include "freertos/FreeRTOS.h"

typedef void *TaskHandle_t;
BaseType_t xTaskCreate(void (*task)(void *), const char *name, uint32_t stack, void *user, unsigned priority,
                       TaskHandle_t *handle);
void vTaskDelay(TickType_t ticks);

#endif
