/*
 * PlotFace - says a sentence over and over and draws the mouth's motion in the Serial Plotter (Tools > Serial Plotter).
 *
 * Needs no parts beside the board.
 */
#include <speech_en.h>

static labial_t face;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];

// Phonemes and their milliseconds, as a speech synthesiser times them: "My baby may be happy."
struct Phone {
    uint8_t phoneme;
    uint16_t milliseconds;
};

static const Phone sentence[] = {
    { SPEECH_EN_SIL, 200 }, { SPEECH_EN_M, 80 },  { SPEECH_EN_AY, 150 }, { SPEECH_EN_B, 90 },  { SPEECH_EN_EY, 160 },
    { SPEECH_EN_B, 80 },    { SPEECH_EN_IY, 90 }, { SPEECH_EN_M, 80 },   { SPEECH_EN_EY, 130 }, { SPEECH_EN_B, 80 },
    { SPEECH_EN_IY, 80 },   { SPEECH_EN_HH, 60 }, { SPEECH_EN_AE, 150 }, { SPEECH_EN_P, 90 },  { SPEECH_EN_IY, 160 },
    { SPEECH_EN_SIL, 500 },
};
static const unsigned phones = sizeof sentence / sizeof sentence[0];

static unsigned nextPhone = 0;
static uint32_t nextFrame = 0;

// Called once per frame, with the 13 channels in FAP units, in the order of labial/faps.h: the jaw (FAP 3, open is
// positive), the upper lip's middle (FAP 51, down is positive) and the lower lip's (FAP 52, up is positive) are drawn.
static void onFrame(void *, uint32_t, const int16_t faps[LABIAL_CHANNELS])
{
    Serial.print("jaw:");
    Serial.print(faps[0]);
    Serial.print(",upper_lip:");
    Serial.print(faps[3]);
    Serial.print(",lower_lip:");
    Serial.println(faps[4]);
}

void setup()
{
    Serial.begin(115200);
    const int result = labial_init(&face, &speech_en, workspace, sizeof workspace, onFrame, NULL);
    while (result != LABIAL_OK) { // says what is wrong, should anything be
        Serial.println(labial_result_text(result));
        delay(1000);
    }
    nextFrame = (uint32_t)millis();
}

void loop()
{
    // Phonemes go in as long as there is room; here they repeat for ever.
    while (labial_room(&face) > 0) {
        labial_push(&face, sentence[nextPhone].phoneme, sentence[nextPhone].milliseconds);
        nextPhone = (nextPhone + 1) % phones;
    }

    // One tick per frame: 20 ms at 50 frames per second. Other work can go on in between.
    if ((int32_t)((uint32_t)millis() - nextFrame) >= 0) {
        nextFrame += 1000 / SPEECH_EN_FPS;
        labial_tick(&face);
    }
}
