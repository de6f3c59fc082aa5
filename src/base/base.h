// base: what every other library stands on. Expected values, diagnostics with a place in a text,
// number text that is the same in every locale, and files that are complete or absent.
#pragma once

#include "base/diagnostic.h"
#include "base/expected.h"
#include "base/hash.h"
#include "base/output_file.h"
#include "base/overloaded.h"
#include "base/source.h"
#include "base/text.h"
