#pragma once

// What the shared library shows. On Windows a program needs no declaration to import functions by, so its
// headers are the same whether it links the static library or the shared one.
#if defined(_WIN32) && defined(CSCD_BUILDING)
#define CSCD_EXPORT __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define CSCD_EXPORT __attribute__((visibility("default")))
#else
#define CSCD_EXPORT
#endif
