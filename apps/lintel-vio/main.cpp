// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelVio.h"

#include <iostream>

int main(int argc, char** argv) { return lintel::runLintelVio(argc, argv, std::cout, std::cerr); }
