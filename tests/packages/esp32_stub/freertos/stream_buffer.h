/* Stub of FreeRTOS's stream buffers. A receive that would wait returns nothing, unless stub_timeout says that it has
 * waited long enough. */
#ifndef STREAM_BUFFER_H
#define STREAM_BUFFER_H

#include "freertos/FreeRTOS.h"

typedef struct stub_buffer *StreamBufferHandle_t;
StreamBufferHandle_t xStreamBufferCreate(size_t size, size_t trigger);
BaseType_t xStreamBufferSetTriggerLevel(StreamBufferHandle_t buffer, size_t trigger);
size_t xStreamBufferSend(StreamBufferHandle_t buffer, const void *data, size_t size, TickType_t wait);
size_t xStreamBufferReceive(StreamBufferHandle_t buffer, void *data, size_t size, TickType_t wait);

#endif
