// What holds for C holds for C++.
#include "header.c"
