/*
 * UnoJaw - a jaw that moves to a recording, on an Arduino Uno or Nano: a DFPlayer Mini plays the sound, talk.h holds
 * the jaw's motion, computed ahead by `labial bake`. docs/arduino.md leads here.
 *
 *     pin 9   servo's signal
 *     pin 1   (TX) through 1 kilohm to the DFPlayer's RX
 *     pin 2   button to ground
 *
 * It speaks at reset, and again whenever the button is pressed.
 */
#include <Servo.h>

// What your jaw needs: the servo's pulses with the mouth closed and wide open, in microseconds.
#define TALK_JAW_AT_0 1400
#define TALK_JAW_AT_255 1900

#include "dfplayer.h"
#include "talk.h"

static const int servoPin = 9;
static const int buttonPin = 2;
static const unsigned long framePeriod = 20; // milliseconds
static const unsigned long commandTime = DFPLAYER_COMMAND_SIZE * 10ul * 1000ul / DFPLAYER_BAUD + 1;

static Servo servo;
static labial_player_t player;
static unsigned long nextFrame = 0;
static bool talking = false;

static void showFrame(const uint8_t *frame)
{
    servo.writeMicroseconds((int)talk_jaw(frame));
}

// Starts the sound; its first frame is due when it is heard.
static void talk()
{
    uint8_t command[DFPLAYER_COMMAND_SIZE];
    dfplayer_play(command, 1, 1); // 01/001.wav on the module's card
    nextFrame = millis() + commandTime + DFPLAYER_DELAY_MS;
    Serial.write(command, sizeof command);
    talk_init(&player);
    talking = true;
}

void setup()
{
    Serial.begin(DFPLAYER_BAUD);
    pinMode(buttonPin, INPUT_PULLUP);
    talk_init(&player);
    showFrame(talk_next(&player)); // before attach(), so that the first pulse is that of rest
    servo.attach(servoPin);
    delay(DFPLAYER_READY_MS);
    talk();
}

void loop()
{
    if (!talking) {
        if (digitalRead(buttonPin) == LOW)
            talk();
    } else if ((long)(millis() - nextFrame) >= 0) {
        nextFrame += framePeriod;
        const uint8_t *frame = talk_next(&player);
        if (frame)
            showFrame(frame);
        else
            talking = false;
    }
}
