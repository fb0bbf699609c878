#pragma once

// For tests and fuzz targets only; one file of a program includes it. libhdf5 leaks memory of its own on
// damaged files, so LeakSanitizer leaves its leaks out. Our code could leak identifiers only, and tests count
// these.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}
