#pragma once

// arb: a library of its own, or part of flint from that one's version 3 on. Its headers are C.
#if __has_include(<flint/arb_mat.h>)
#include <flint/arb_mat.h>
#else
#include <arb_mat.h>
#endif
