/*
 * app_main.c - runs the device tests in the main task of ESP-IDF.
 */
#include "device.h"

void app_main(void);

void app_main(void)
{
    device_tests();
}
