/*
 * Arduino.h - as much of the Arduino core as the example sketches use, to compile and run them on a host.
 */
#ifndef ARDUINO_STUB_H
#define ARDUINO_STUB_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define constrain(x, low, high) ((x) < (low) ? (low) : ((x) > (high) ? (high) : (x)))

class HardwareSerial {
public:
    void begin(unsigned long baud);
    int available();
    int read();
    void print(const char *text);
    void print(int value);
    void println(const char *text);
    void println(int value);
};

extern HardwareSerial Serial;

unsigned long millis();
void delay(unsigned long milliseconds);

void setup();
void loop();

#endif
