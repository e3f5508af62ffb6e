// Keys of problem files under the names that they had before.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/config_tree.h"
#include "ibrdf/io/problem_schema.h"

namespace ibrdf {

// Gives every key of the tree that has a former name (ProblemKey::old_name) its
// new one, with a warning that names `file`, the old path and the new one.
// Refuses a key that is there under both names.
Status RenameOldKeys(const ProblemSchema& schema, const std::string& file,
                     ConfigNode* root);

// The same for an override of that file, "key.path=value": the result has the
// key's new name.
std::string WithNewName(const ProblemSchema& schema, const std::string& file,
                        const std::string& override_text);

}  // namespace ibrdf
