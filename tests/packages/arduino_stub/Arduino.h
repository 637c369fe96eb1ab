/*
 * Arduino.h - as much of the Arduino core as the example sketches use, to compile and run them on a host.
 */
#ifndef ARDUINO_STUB_H
#define ARDUINO_STUB_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define constrain(x, low, high) ((x) < (low) ? (low) : ((x) > (high) ? (high) : (x)))

#define LOW 0x0
#define HIGH 0x1
#define INPUT_PULLUP 0x2
#define SERIAL_8N1 0x800001c /* the ESP32's */

class HardwareSerial
{
  public:
    void begin(unsigned long baud);
    void begin(unsigned long baud, uint32_t config, int rx_pin, int tx_pin); /* the ESP32's */
    int available();
    int read();
    size_t write(const uint8_t *bytes, size_t count);
    void print(const char *text);
    void print(int value);
    void println(const char *text);
    void println(int value);
};

extern HardwareSerial Serial, Serial2;

unsigned long millis();
void delay(unsigned long milliseconds);
void pinMode(uint8_t pin, uint8_t mode);
int digitalRead(uint8_t pin);

void setup();
void loop();

#endif
