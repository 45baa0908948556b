// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "lintel/programs/LintelBench.h"

int main(int argc, char** argv) { return lintel::runLintelBench(argc, argv, std::cout, std::cerr); }
