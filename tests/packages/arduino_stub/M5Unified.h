/*
 * M5Unified.h - as much of the library M5Unified as the example sketches use.
 */
#ifndef ARDUINO_STUB_M5UNIFIED_H
#define ARDUINO_STUB_M5UNIFIED_H

namespace m5
{

class Button_Class
{
  public:
    bool wasPressed() const;
};

class M5Unified
{
  public:
    void begin();
    void update();
    Button_Class BtnA;
};

} // namespace m5

extern m5::M5Unified M5;

#endif
