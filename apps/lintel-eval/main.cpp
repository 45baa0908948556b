// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "lintel/programs/LintelEval.h"

int main(int argc, char** argv) { return lintel::runLintelEval(argc, argv, std::cout, std::cerr); }
