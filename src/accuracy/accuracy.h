// accuracy: what the cutting forces of all engaged tools do to the size of the part. Force laws,
// the elastic machine as a tree of bodies, size errors, their scatter over a batch, and the set-up
// file that describes it all. Everything in the machine frame; mm, N, rad, N·mm inside, the
// practical units (µm/N, N·m, µm, µrad) only in files.
#pragma once

#include "accuracy/beam.h"
#include "accuracy/copying.h"
#include "accuracy/evaluate.h"
#include "accuracy/matrices.h"
#include "accuracy/milling.h"
#include "accuracy/rods.h"
#include "accuracy/scatter.h"
#include "accuracy/setup.h"
#include "accuracy/size.h"
#include "accuracy/stability.h"
#include "accuracy/structure.h"
#include "accuracy/sweep.h"
#include "accuracy/text.h"
#include "accuracy/turning.h"
