#include "device_backend.h"
#include "typed_fib.h"
