// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::test {

/// A folder of one test alone.
using Scratch = kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;

}  // namespace steadyrest::test
