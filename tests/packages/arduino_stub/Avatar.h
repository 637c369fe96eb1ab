/*
 * Avatar.h - as much of the library M5Stack_Avatar as the example sketches use.
 */
#ifndef ARDUINO_STUB_AVATAR_H
#define ARDUINO_STUB_AVATAR_H

namespace m5avatar
{

class Avatar
{
  public:
    void init();
    void setMouthOpenRatio(float ratio);
};

} // namespace m5avatar

#endif
