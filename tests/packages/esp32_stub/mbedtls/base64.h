/* Stub of Mbed TLS: its decoder of base64. */
#ifndef MBEDTLS_BASE64_H
#define MBEDTLS_BASE64_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

int mbedtls_base64_decode(unsigned char *to, size_t room, size_t *size, const unsigned char *from, size_t length);

#ifdef __cplusplus
}
#endif

#endif
