#include "device_backend.h"
#include "typed_stokes.h"
