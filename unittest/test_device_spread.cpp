#include "device_backend.h"
#include "typed_spread.h"
