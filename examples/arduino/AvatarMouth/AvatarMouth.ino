/*
 * AvatarMouth - the mouth of M5Stack-Avatar follows the lips: says a sentence at reset, and again whenever button A is
 * pressed. Needs the libraries M5Unified and M5Stack_Avatar. talk_phonemes.h holds what is said:
 *
 *     labial bake talk.wav --text "..." --as phonemes -o talk_phonemes.h
 */
#include <M5Unified.h>

#include <Avatar.h>
#include <labial/rig.h>

#include "talk_phonemes.h"

// The mouth's opening, in thousandths: closed and wide open.
static const labial_rig_output_t opening = LABIAL_RIG_JAW(0, 1000);
static const labial_rig_t mouth = { &opening, 1 };
static int32_t thousandths;

static m5avatar::Avatar avatar;
static labial_t face;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t nextPhoneme = 0;
static uint32_t nextFrame = 0;
static bool talking = false;

static void onFrame(void *, uint32_t, const int16_t faps[LABIAL_CHANNELS])
{
    labial_rig_apply(&mouth, faps, &thousandths);
    avatar.setMouthOpenRatio((float)thousandths / 1000.0f);
}

// Accepts one frame, and delivers the one accepted `delay` frames ago.
static void nextTick()
{
    talking = talk_phonemes_feed(&face, &nextPhoneme) == LABIAL_OK && labial_tick(&face) != LABIAL_DONE;
}

// Takes up as many frames as the first one waits for, which is then shown at once: start your sound at the end of this.
static void talk()
{
    nextPhoneme = 0;
    talking = true;
    for (unsigned ahead = labial_latency(&face).delay; ahead > 0 && talking; ahead--)
        nextTick();
    nextFrame = (uint32_t)millis();
}

void setup()
{
    M5.begin();
    avatar.init();
    labial_rig_rest(&mouth, &thousandths);
    if (labial_init(&face, &speech_en, workspace, sizeof workspace, onFrame, NULL) == LABIAL_OK)
        talk();
}

void loop()
{
    M5.update();
    if (!talking) {
        if (M5.BtnA.wasPressed() && labial_restart(&face) == LABIAL_OK)
            talk();
    } else if ((int32_t)((uint32_t)millis() - nextFrame) >= 0) {
        nextFrame += 1000 / SPEECH_EN_FPS;
        nextTick();
    }
}
