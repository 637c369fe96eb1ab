/*
 * JawServo - a servo moves a jaw. What comes in over the serial line is spoken: phonemes and milliseconds, such as
 *
 *     HH 70 AH 60 L 80 OW 250
 *
 * with a line end. Every name that labial_find() knows will do: ARPABET, flite's, IPA.
 *
 * A servo at pin 9. Boards of the ESP32 family use the library ESP32Servo: replace Servo.h by ESP32Servo.h.
 */
#include <Servo.h>
#include <labial/rig.h>
#include <speech_en.h>

// What your jaw needs: the servo's angles with the mouth closed and wide open, in degrees.
static const int closedAngle = 80;
static const int openAngle = 110;
static const int servoPin = 9;

// The jaw follows the opening of the lips, for m, b and p must close a mouth that has nothing but a jaw.
static const labial_rig_output_t jaw = LABIAL_RIG_JAW(closedAngle, openAngle);
static const labial_rig_t rig = { &jaw, 1 };
static int32_t angle;

static Servo servo;
static labial_t face;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t nextFrame = 0;

// The word that is being read, and the phoneme that waits for its milliseconds.
static char word[16];
static uint8_t length = 0;
static int phoneme = LABIAL_ERROR_NAME;
static bool speaking = false;

static void onFrame(void *, uint32_t, const int16_t faps[LABIAL_CHANNELS])
{
    labial_rig_apply(&rig, faps, &angle);
    servo.write((int)angle);
}

// Ends the word: a number is the milliseconds of the phoneme before it, anything else a phoneme's name.
static void takeWord()
{
    if (length == 0)
        return;
    word[length] = '\0';
    if (word[0] >= '0' && word[0] <= '9' && phoneme >= 0) {
        const int result = labial_push(&face, (unsigned)phoneme, (uint32_t)atol(word));
        if (result < 0)
            Serial.println(labial_result_text(result));
        speaking = true;
        phoneme = LABIAL_ERROR_NAME;
    } else {
        phoneme = labial_find(&speech_en_names, word, length);
        if (phoneme < 0)
            Serial.println(labial_result_text(phoneme));
    }
    length = 0;
}

void setup()
{
    Serial.begin(115200);
    servo.attach(servoPin);
    labial_rig_rest(&rig, &angle);
    servo.write((int)angle);
    const int result = labial_init(&face, &speech_en, workspace, sizeof workspace, onFrame, NULL);
    while (result != LABIAL_OK) {
        Serial.println(labial_result_text(result));
        delay(1000);
    }
    nextFrame = (uint32_t)millis();
}

void loop()
{
    while (Serial.available() > 0 && labial_room(&face) > 0) {
        const char c = (char)Serial.read();
        if (c == ' ' || c == '\r' || c == '\n') {
            takeWord();
            if (c == '\n' && speaking) { // nothing follows, so the last phonemes need not wait for what does
                labial_end(&face);
                speaking = false;
            }
        } else if (length < sizeof word - 1) {
            word[length++] = c;
        }
    }

    if ((int32_t)((uint32_t)millis() - nextFrame) >= 0) {
        nextFrame += 1000 / SPEECH_EN_FPS;
        if (labial_tick(&face) == LABIAL_DONE)
            labial_restart(&face); // ready for the next sentence
    }
}
