// test_main.cpp - runs the device tests where PlatformIO expects a test: in setup() of Arduino's core, else in main().
extern "C" int device_tests(void);

#ifdef ARDUINO

#include <Arduino.h>

void setup()
{
    delay(2000); // until the serial monitor listens
    device_tests();
}

void loop()
{
}

#else

int main()
{
    return device_tests();
}

#endif
