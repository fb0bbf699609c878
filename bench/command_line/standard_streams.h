#pragma once

namespace cscd::bench {

// Call first in main. Gives standard input, output and error a descriptor each where the caller has closed
// them, so that no output file is opened in their place and printed into; writing to such a stand-in fails.
// Turns broken pipes and full files from signals into errors.
void prepare_standard_streams();

// Call last in main. Hands on what has been printed. Returns `status`, or 2 after one line on standard error
// if standard output did not take all of it. If nobody reads standard output any more (`| head -1`), ends the
// process by SIGPIPE without a word, as other programs do.
int finish_standard_output(int status);

// Ends the process by SIGPIPE.
[[noreturn]] void end_by_broken_pipe();

}  // namespace cscd::bench
