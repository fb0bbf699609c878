#pragma once

#include <filesystem>
#include <string>

#include "bench/inputs/input.h"

namespace cscd::bench {

// Writes the frames of an input in the formats that other programs read, and prints what was written. Files
// appear whole or not at all, and none is written if one of them exists (unless `force`). Throws InputError.
//   .obj .ply   a file a frame, NAME.0000.obj and so on, bit for bit; with `events`, for .ply alone, also how
//               deep each vertex lies in another piece, and NAME.curves.0000.obj with the curves of crossings
//   .pc2 .mdd   a mesh cache in single precision, beside NAME.obj with the faces
//   .pvd        a list for ParaView, and beside it NAME.0000.vtp a frame with cluster, orientation, what
//               touches and what crosses, and NAME.contacts.0000.vtp with the contacts of its interval
//   .usda       points and colours over time, and the contacts as points
//   .glb        morph targets, without bones
//
// Frames have the numbers by which answers about the input name them. A line says so where a format cannot
// hold these numbers, and counts from 0.
void export_files(Input& input, const std::filesystem::path& output, const std::string& format, bool force,
                  bool events);

// Returns the file behind all links of an output's name (find_output_target). Throws InputError for a device
// or a pipe, too.
std::filesystem::path file_target(const std::filesystem::path& output, bool force);

// Says that the files of an input count their frames from 0 where its first frame has another number.
void note_renumbered(const Input& input);

}  // namespace cscd::bench
