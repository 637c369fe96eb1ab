/*
 * FaceServos - a face of five servos on a PCA9685, moved by an ESP32 that computes every frame; a DFPlayer Mini plays the
 * recording. talk_phonemes.h holds what is said:
 *
 *     labial bake talk.wav --text "..." --as phonemes -o talk_phonemes.h
 *
 * servos.h and servos.c say what moves how far; they come from servos.toml by `labial rig`, and so will yours. The jaw, the
 * upper lip, the lower lip and the corners are on the channels 0 to 4.
 *
 *     21, 22   SDA, SCL of the PCA9685
 *     17       (TX) through 1 kilohm to the DFPlayer's RX
 *     0        the board's own button BOOT
 *
 * It speaks at reset, and again whenever the button is pressed.
 */
#include <Wire.h>
#include <labial/rig.h>

#include "dfplayer.h"
#include "servos.h"
#include "talk_phonemes.h"

static const uint8_t pca9685 = 0x40; // its address
static const int sdaPin = 21;
static const int sclPin = 22;
static const int playerRxPin = 16; // not connected
static const int playerTxPin = 17;
static const int buttonPin = 0;
static const uint32_t framePeriod = 1000 / SPEECH_EN_FPS; // milliseconds
static const uint32_t commandTime = DFPLAYER_COMMAND_SIZE * 10ul * 1000ul / DFPLAYER_BAUD + 1;

static labial_t face;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static int32_t ticks[SERVOS_OUTPUTS]; // of each servo's pulse
static uint32_t nextPhoneme = TALK_PHONEMES_PHONEMES;
static uint32_t nextFrame = 0;
static bool talking = false;

static void setRegister(uint8_t number, uint8_t value)
{
    Wire.beginTransmission(pca9685);
    Wire.write(number);
    Wire.write(value);
    Wire.endTransmission();
}

static void beginServos()
{
    setRegister(0x00, 0x10); // MODE1: asleep, for only then can the period be set
    setRegister(0xfe, SERVOS_PCA9685_PRESCALE);
    setRegister(0x00, 0x20); // MODE1: awake, registers follow one another
    delay(1);                // until the oscillator runs
}

static void showServos()
{
    Wire.beginTransmission(pca9685);
    Wire.write(0x06); // LED0_ON_L: the pulses begin at tick 0 and end at their length
    for (unsigned i = 0; i < SERVOS_OUTPUTS; i++) {
        Wire.write(0);
        Wire.write(0);
        Wire.write((uint8_t)(ticks[i] & 0xff));
        Wire.write((uint8_t)(ticks[i] >> 8));
    }
    Wire.endTransmission();
}

static void onFrame(void *, uint32_t, const int16_t faps[LABIAL_CHANNELS])
{
    labial_rig_apply(&servos, faps, ticks);
    showServos();
}

// Takes one frame up, and delivers the one of `delay` frames ago.
static void nextTick()
{
    int result = talk_phonemes_feed(&face, &nextPhoneme);
    if (result == LABIAL_OK)
        result = labial_tick(&face);
    if (result < 0)
        Serial.println(labial_result_text(result));
    talking = result >= 0 && result != LABIAL_DONE;
}

// Starts the sound, and takes up as many frames as the first one waits for: it is then due when the sound is heard.
static void talk()
{
    uint8_t command[DFPLAYER_COMMAND_SIZE];
    dfplayer_play(command, 1, 1); // 01/001.wav on the module's card
    nextFrame = (uint32_t)millis() + commandTime + DFPLAYER_DELAY_MS;
    Serial2.write(command, sizeof command);
    nextPhoneme = 0;
    talking = true;
    for (unsigned ahead = labial_latency(&face).delay; ahead > 0 && talking; ahead--)
        nextTick();
}

void setup()
{
    Serial.begin(115200);
    Serial2.begin(DFPLAYER_BAUD, SERIAL_8N1, playerRxPin, playerTxPin);
    pinMode(buttonPin, INPUT_PULLUP);
    Wire.begin(sdaPin, sclPin, 400000);
    beginServos();
    labial_rig_rest(&servos, ticks);
    showServos();
    const int result = labial_init(&face, &speech_en, workspace, sizeof workspace, onFrame, NULL);
    if (result != LABIAL_OK)
        Serial.println(labial_result_text(result));
    delay(DFPLAYER_READY_MS);
    talk();
}

void loop()
{
    if (!talking) {
        if (digitalRead(buttonPin) == LOW && labial_restart(&face) == LABIAL_OK)
            talk();
    } else if ((int32_t)((uint32_t)millis() - nextFrame) >= 0) {
        nextFrame += framePeriod;
        nextTick();
    }
}
