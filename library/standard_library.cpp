#include "cscd/standard_library.h"

extern "C" const char CSCD_CONTAINERS = 0;
