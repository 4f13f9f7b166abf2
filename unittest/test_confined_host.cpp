#include "bdh_host.h"
#define TEST_BACKEND bdh::HostBackend
#include "typed_confined.h"
