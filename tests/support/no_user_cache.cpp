// Part of every test program: tests neither use nor fill the cache of whoever runs them, and say so where they want one.
#include <cstdlib>

namespace {

[[maybe_unused]] const int kIsOff = ::setenv("NEARFIT_CACHE", "off", 1);

}  // namespace
