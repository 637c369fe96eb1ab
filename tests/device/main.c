/*
 * main.c - the device tests as an image of their own.
 */
#include "device.h"

int main(void)
{
    return device_tests();
}
