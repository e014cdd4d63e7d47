// Carries the precompiled headers that test programs share; see tests/CMakeLists.txt.
