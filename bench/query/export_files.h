#pragma once

#include <filesystem>
#include <string>

#include "bench/answer/clip_answerer.h"
#include "bench/inputs/input.h"

namespace cscd::bench {

// Frames in formats that other programs read. Each function prints what was written. Files appear whole or
// not at all, and none is written if one of them exists (unless `force`). Throws InputError.
//
// Frames have the numbers by which answers about the input name them. A line says so where a format cannot
// hold these numbers, and counts from 0.

// The frames from range.first to range.last alone:
//   .h5         a point cache, exactly
//   .obj .ply   a file a frame, NAME.0000.obj and so on, bit for bit
//   .pc2 .mdd   a mesh cache in single precision, beside NAME.obj with the faces
//   .glb        morph targets, without bones
void export_frames(const Input& input, const IntervalRange& range, const std::filesystem::path& output,
                   const std::string& format, bool force);

// The same with answers about them:
//   .ply    with how deep each vertex lies in another piece, and NAME.curves.0000.obj with the curves of
//           crossings
//   .pvd    a list for ParaView, and beside it NAME.0000.vtp a frame with cluster, orientation, what touches
//           and what crosses, and NAME.contacts.0000.vtp with the contacts of its interval
//   .usda   points and colours over time, and the contacts as points
void export_answers(ClipAnswerer& asked, const std::filesystem::path& output, const std::string& format,
                    bool force);

// Returns the file behind all links of an output's name (find_output_target). Throws InputError for a device
// or a pipe, too.
std::filesystem::path file_target(const std::filesystem::path& output, bool force);

}  // namespace cscd::bench
