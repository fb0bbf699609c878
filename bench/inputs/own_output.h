#pragma once

#include <string>

namespace cscd::bench {

// Says of a file that this program or its scripts wrote, and that is no input, what it is and which command
// takes it, as in "is a record of cscd run; cscd tables FILE shows it". Empty for everything else, scene
// files included. Records and answers are told by the schema that they name, also where they are compressed.
std::string why_own_output(const std::string& path);

}  // namespace cscd::bench
