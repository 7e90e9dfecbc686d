// Stands in for Apple's: what the program wants of it.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C"
#endif
    int
    _NSGetExecutablePath(char*, uint32_t*);
