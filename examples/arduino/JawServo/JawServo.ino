/*
 * JawServo - a servo moves a jaw. What comes in over the serial line is spoken: phonemes and milliseconds, such as
 *
 *     HH 70 AH 60 L 80 OW 250
 *
 * with a line end; up to 255 phonemes wait, some 80 words, and of more it says that they are left out. Every name that
 * labial_find() knows will do: ARPABET, flite's, IPA. The word `stop` drops what waits, and the mouth closes.
 *
 * A servo at pin 9. Boards of the ESP32 family use the library ESP32Servo: replace Servo.h by ESP32Servo.h.
 */
#include <Servo.h>
#include <labial/face.h>
#include <speech_en.h>

// What your jaw needs: the servo's angles with the mouth closed and wide open, and how far it gets in 20 ms, in
// degrees.
static const int closedAngle = 80;
static const int openAngle = 110;
static const int speed = 10;
static const int servoPin = 9;

// Frames that are known before one is shown, so that the servo closes in time; the mouth is 80 ms later.
static const unsigned ahead = 4;

// The jaw follows the opening of the lips, for m, b and p must close a mouth that has nothing but a jaw.
static const labial_rig_output_t jaw = LABIAL_RIG_SERVO(closedAngle, openAngle, speed);
static const labial_rig_t rig = { &jaw, 1 };

static Servo servo;
static bool attached = false;
static labial_face_t face;
static int32_t room[LABIAL_FACE_SIZE(1, ahead) / 4];
static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];

// Phonemes for which the stream has no room yet, each with its milliseconds above its number: the line sends them
// faster than the jaw speaks them, and does not wait. One more place is for the end of the line.
static const unsigned most = 255;
static const uint32_t lineEnd = 255;
static uint32_t waiting[most + 1];
static unsigned first = 0, held = 0;

// The word that is being read, and the phoneme that waits for its milliseconds.
static char word[16];
static uint8_t length = 0;
static int phoneme = LABIAL_ERROR_NAME;
static bool speaking = false, tooLong = false;

static void keep(uint32_t item)
{
    waiting[(first + held++) % (most + 1)] = item;
}

// Ends the word: a number is the milliseconds of the phoneme before it, `stop` drops all, and anything else is a
// phoneme's name.
static void takeWord()
{
    if (length == 0)
        return;
    word[length] = '\0';
    if (word[0] >= '0' && word[0] <= '9' && phoneme >= 0) {
        const uint32_t milliseconds = (uint32_t)atol(word);
        if (milliseconds > LABIAL_DURATION_MAX) {
            Serial.println(labial_result_text(LABIAL_ERROR_DURATION));
        } else if (held < most) {
            keep((uint32_t)phoneme | milliseconds << 8);
            speaking = true;
        } else if (!tooLong) {
            Serial.println("too long: the rest of the line is left out");
            tooLong = true;
        }
        phoneme = LABIAL_ERROR_NAME;
    } else if (strcmp(word, "stop") == 0) {
        labial_cancel(&stream, 200);
        held = 0;
        speaking = false;
        phoneme = LABIAL_ERROR_NAME;
    } else {
        phoneme = labial_find(&speech_en_names, word, length);
        if (phoneme < 0)
            Serial.println(labial_result_text(phoneme));
    }
    length = 0;
}

// Reads what has come in.
static void readLine()
{
    while (Serial.available() > 0) {
        const char c = (char)Serial.read();
        if (c == ' ' || c == '\r' || c == '\n') {
            takeWord();
            if (c == '\n') {
                if (speaking)
                    keep(lineEnd);
                speaking = tooLong = false;
            }
        } else if (length < sizeof word - 1) {
            word[length++] = c;
        }
    }
}

// Hands on what the stream has room for: none after the end of a line until that is spoken.
static void speak()
{
    for (; held > 0 && labial_room(&stream) > 0; held--) {
        const uint32_t item = waiting[first];
        if (item == lineEnd) // nothing follows, so the last phonemes need not wait for what does
            labial_end(&stream);
        else
            labial_push(&stream, item & 255, item >> 8);
        first = (first + 1) % (most + 1);
    }
}

// The first angle is that of rest. Libraries for some boards keep it from before attach(), those for others take it
// after.
static void show(int32_t angle)
{
    servo.write((int)angle);
    if (!attached) {
        servo.attach(servoPin);
        servo.write((int)angle);
        attached = true;
    }
}

void setup()
{
    Serial.begin(115200);
    int result = labial_face_init(&face, &rig, SPEECH_EN_FPS, ahead, room, sizeof room);
    if (result == LABIAL_OK)
        result = labial_init(&stream, &speech_en, workspace, sizeof workspace, labial_face_frame, &face);
    while (result != LABIAL_OK) {
        Serial.println(labial_result_text(result));
        delay(1000);
    }
    labial_face_soft_start(&face, 25); // half a second to get to rest
}

void loop()
{
    readLine();
    speak();
    if (labial_face_due(&face, (uint32_t)millis())) {
        int32_t angle;
        if (labial_tick(&stream) == LABIAL_DONE)
            labial_restart(&stream); // ready for the next sentence
        labial_face_tick(&face, &angle);
        show(angle);
    }
}
