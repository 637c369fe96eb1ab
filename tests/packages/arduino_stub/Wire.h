/*
 * Wire.h - as much of the ESP32's I2C as the example sketches use.
 */
#ifndef ARDUINO_STUB_WIRE_H
#define ARDUINO_STUB_WIRE_H

#include <stddef.h>
#include <stdint.h>

class TwoWire
{
  public:
    bool begin(int sda_pin, int scl_pin, uint32_t frequency);
    void beginTransmission(uint8_t address);
    size_t write(uint8_t byte);
    uint8_t endTransmission();
};

extern TwoWire Wire;

#endif
