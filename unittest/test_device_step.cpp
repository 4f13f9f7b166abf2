#include "device_backend.h"
#include "typed_step.h"
