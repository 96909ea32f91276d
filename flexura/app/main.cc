#include "flexura/app/app.h"

int main(int argc, char** argv) { return flexura::run_app(argc, argv); }
