/*
 * servos.c - faces without structures (flat.h).
 */
#include "flat.h"

FLAT_RETURNS(uint32_t servos_size(unsigned outputs, unsigned ahead),
             (uint32_t)(sizeof(servos_t) + LABIAL_FACE_SIZE(outputs, ahead)))

int servos_init(servos_t *servos, const labial_rig_output_t *outputs, unsigned count, unsigned ahead)
{
    servos->rig.outputs = outputs;
    servos->rig.count = (uint16_t)count;
    return labial_face_init(&servos->face, &servos->rig, 50, ahead, (int32_t *)(servos + 1),
                            LABIAL_FACE_SIZE(count, ahead));
}

FLAT_RETURNS(int servos_frame(servos_t *servos, const int16_t *faps, const uint8_t *shares),
             labial_face_visemes(&servos->face, faps, shares))
FLAT_RETURNS(int servos_values(servos_t *servos, const int32_t *wanted), labial_face_values(&servos->face, wanted))
FLAT_RETURNS(int servos_tick(servos_t *servos, int32_t *values), labial_face_tick(&servos->face, values))
FLAT_RETURNS(int servos_play(servos_t *servos), labial_face_play(&servos->face))
FLAT_RETURNS(int servos_skip(servos_t *servos, unsigned count), labial_face_skip(&servos->face, count))
FLAT_RETURNS(int servos_cancel(servos_t *servos, uint32_t milliseconds),
             labial_face_cancel(&servos->face, milliseconds))
FLAT_RETURNS(int servos_soft_start(servos_t *servos, unsigned ticks), labial_face_soft_start(&servos->face, ticks))
FLAT_RETURNS(unsigned servos_attached(const servos_t *servos), labial_face_attached(&servos->face))
FLAT_RETURNS(int servos_place(servos_t *servos, const int32_t *values), labial_face_place(&servos->face, values))
