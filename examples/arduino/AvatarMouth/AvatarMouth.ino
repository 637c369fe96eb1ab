/*
 * AvatarMouth - the mouth of M5Stack-Avatar follows the lips: says a sentence at reset, and again whenever button A is
 * pressed. Needs the libraries M5Unified and M5Stack_Avatar. talk_phonemes.h holds what is said:
 *
 *     labial bake talk.wav --text "..." --as phonemes -o talk_phonemes.h
 */
#include <M5Unified.h>

#include <Avatar.h>
#include <labial/face.h>

#include "talk_phonemes.h"

// The mouth's opening, in thousandths: closed and wide open.
static const labial_rig_output_t opening = LABIAL_RIG_JAW(0, 1000);
static const labial_rig_t mouth = { &opening, 1 };

static m5avatar::Avatar avatar;
static labial_face_t face;
static int32_t room[LABIAL_FACE_SIZE(1, 0) / 4];
static labial_t stream;
static uint32_t workspace[SPEECH_EN_WORKSPACE_SIZE / 4];
static uint32_t nextPhoneme = 0;
static bool talking = false;

// Accepts one frame, and delivers the one accepted `delay` frames ago.
static void nextTick()
{
    talking = talk_phonemes_feed(&stream, &nextPhoneme) == LABIAL_OK && labial_tick(&stream) != LABIAL_DONE;
}

// Takes up as many frames as the first one waits for, which is then shown in the next period: start your sound at the
// end of this.
static void talk()
{
    nextPhoneme = 0;
    talking = true;
    for (unsigned ahead = labial_latency(&stream).delay; ahead > 0 && talking; ahead--)
        nextTick();
}

void setup()
{
    M5.begin();
    avatar.init();
    if (labial_face_init(&face, &mouth, SPEECH_EN_FPS, 0, room, sizeof room) == LABIAL_OK &&
        labial_init(&stream, &speech_en, workspace, sizeof workspace, labial_face_frame, &face) == LABIAL_OK)
        talk();
}

void loop()
{
    M5.update();
    if (!talking && M5.BtnA.wasPressed() && labial_restart(&stream) == LABIAL_OK)
        talk();
    if (labial_face_due(&face, (uint32_t)millis())) {
        int32_t thousandths;
        if (talking)
            nextTick();
        labial_face_tick(&face, &thousandths);
        avatar.setMouthOpenRatio((float)thousandths / 1000.0f);
    }
}
