// Where results go: writable folders, and no file that a problem reads.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_file.h"

namespace ibrdf {

// Makes `folder` where need be; kInvalidInput where nothing can be written to
// it. Call it before a solve.
Status PrepareFolder(const std::string& folder);

// kInvalidInput where one of the paths is a file that the problem names, or one
// of `more`, which files that it names do. A result would replace it. Call it
// before a solve or a render.
Status CheckNothingReplaced(const Problem& problem,
                            const std::vector<std::string>& paths,
                            const std::vector<NamedFile>& more = {});

// The folder of a view's results: folder/views/NAME.
std::string ViewFolder(const std::string& folder, const std::string& name);

// Removes from the folder the names that an earlier run left and this one does
// not write, but no file that the problem names.
void RemoveEarlier(const Problem& problem, const std::string& folder,
                   const std::vector<std::string>& names);

}  // namespace ibrdf
