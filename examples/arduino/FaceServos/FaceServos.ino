/*
 * FaceServos - a face of five servos on a PCA9685, moved by an ESP32 that computes every frame; a DFPlayer Mini plays
 * the recording. talk_phonemes.h holds what is said:
 *
 *     labial bake talk.wav --text "..." --as phonemes -o talk_phonemes.h
 *
 * servos.h and servos.c say what moves how far; they come from servos.toml by `labial rig`, and so will yours. The jaw,
 * the upper lip, the lower lip and the corners are on the channels 0 to 4.
 *
 *     21, 22   SDA, SCL of the PCA9685
 *     17       (TX) through 1 kilohm to the DFPlayer's RX
 *     0        the board's own button BOOT
 *
 * It speaks at reset, and again whenever the button is pressed.
 */
#include <Wire.h>
#include <labial/face.h>

#include "dfplayer.h"
#include "servos.h"
#include "talk_phonemes.h"

static const uint8_t pca9685 = 0x40; // its address
static const int sdaPin = 21;
static const int sclPin = 22;
static const int playerRxPin = 16; // not connected
static const int playerTxPin = 17;
static const int buttonPin = 0;
static const uint32_t commandTime = DFPLAYER_COMMAND_SIZE * 10ul * 1000ul / DFPLAYER_BAUD + 1;

static labial_face_t face;
static int32_t room[LABIAL_FACE_SIZE(SERVOS_OUTPUTS, 0) / 4];
static int32_t ticks[SERVOS_OUTPUTS]; // of each servo's pulse
static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t nextPhoneme = TALK_PHONEMES_PHONEMES;
static uint32_t heard = 0; // when the sound is, milliseconds
static bool ready = false; // the player has read its card
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

// A channel has no pulses before its first value: so the servos are attached one by one.
static void showServos()
{
    Wire.beginTransmission(pca9685);
    Wire.write(0x06); // LED0_ON_L: the pulses begin at tick 0 and end at their length
    for (unsigned i = 0; i < labial_face_attached(&face); i++) {
        Wire.write(0);
        Wire.write(0);
        Wire.write((uint8_t)(ticks[i] & 0xff));
        Wire.write((uint8_t)(ticks[i] >> 8));
    }
    Wire.endTransmission();
}

// Takes one frame up, and delivers the one of `delay` frames ago.
static void nextTick()
{
    int result = talk_phonemes_feed(&stream, &nextPhoneme);
    if (result == LABIAL_OK)
        result = labial_tick(&stream);
    if (result < 0)
        Serial.println(labial_result_text(result));
    talking = result >= 0 && result != LABIAL_DONE;
}

// Starts the sound, and takes up as many frames as the first one waits for: it is then due when the sound is heard.
static void talk()
{
    uint8_t command[DFPLAYER_COMMAND_SIZE];
    dfplayer_play(command, 1, 1); // 01/001.wav on the module's card
    heard = (uint32_t)millis() + commandTime + DFPLAYER_DELAY_MS;
    Serial2.write(command, sizeof command);
    nextPhoneme = 0;
    talking = true;
    for (unsigned ahead = labial_latency(&stream).delay; ahead > 0 && talking; ahead--)
        nextTick();
}

void setup()
{
    Serial.begin(115200);
    Serial2.begin(DFPLAYER_BAUD, SERIAL_8N1, playerRxPin, playerTxPin);
    pinMode(buttonPin, INPUT_PULLUP);
    Wire.begin(sdaPin, sclPin, 400000);
    beginServos();
    int result = labial_face_init(&face, &servos, SPEECH_EN_FPS, 0, room, sizeof room);
    if (result == LABIAL_OK)
        result = labial_init(&stream, &speech_en, workspace, sizeof workspace, labial_face_frame, &face);
    if (result != LABIAL_OK)
        Serial.println(labial_result_text(result));
    labial_face_soft_start(&face, 25); // half a second for each servo
}

void loop()
{
    const uint32_t now = (uint32_t)millis();
    if (!ready && now >= DFPLAYER_READY_MS) {
        ready = true;
        talk();
    } else if (ready && !talking && digitalRead(buttonPin) == LOW && labial_restart(&stream) == LABIAL_OK) {
        talk();
    }
    if (labial_face_due(&face, now)) {
        if (talking && (int32_t)(now - heard) >= 0)
            nextTick();
        labial_face_tick(&face, ticks);
        showServos();
    }
}
