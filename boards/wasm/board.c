/*
 * board.c - board.h in WebAssembly. Text goes to the program that runs the image (run.mjs); there is no counter of
 * instructions, and the depth of the stack is unknown.
 */
#include "board.h"

#define IMPORT(name) __attribute__((import_module("board"), import_name(name)))

IMPORT("put") extern void wasm_put(uint32_t character);
IMPORT("exit") extern void wasm_exit(int32_t status);

int main(void);
int32_t run(void);

/* Called by run.mjs. */
__attribute__((export_name("run"))) int32_t run(void)
{
    return main();
}

void board_put(char character)
{
    wasm_put((uint8_t)character);
}

void board_exit(int status)
{
    wasm_exit(status); /* does not return */
}
