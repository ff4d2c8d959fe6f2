/* Runs a program that was made a library, with input 1 set after a second, and prints what it said:
 *
 *     arl2rs build --library fill.arl
 *     cc run.c -I CHECKOUT/library -ldl -o run
 *     ./run ./libfill.so --robot six-10
 */
#include "arl.h"

#include <dlfcn.h>
#include <stdio.h>

static void print(void *stream, const char *text, size_t length) {
    fwrite(text, 1, length, stream);
}

int main(int count, char **words) {
    void *library = count > 1 ? dlopen(words[1], RTLD_NOW) : NULL;
    const ArlInterface *(*ask)(void) = NULL;
    if (library)
        *(void **)&ask = dlsym(library, "arl_interface");
    const ArlInterface *arl = ask ? ask() : NULL;
    if (!arl || arl->version != ARL_INTERFACE) {
        fprintf(stderr, "usage: run LIBRARY [OPTION...], with a library of this version of arl2rs\n");
        return 2;
    }

    ArlRun *run = arl->begin((const char *const *)(words + 2), (size_t)(count - 2), 0, print, stderr);
    if (!run)
        return 2;
    int32_t code = arl->go_on(run, 1000, 0); /* cycles: a second, as a cycle takes 1 ms */
    if (code == ARL_RUNS && arl->order(run, "di.1 = true", print, stderr) == 0)
        while (code == ARL_RUNS)
            code = arl->go_on(run, 100000, 1);
    arl->said(run, print, stdout);
    printf("%.3f s, code %d\n", arl->time(run), (int)code);
    arl->end(run);
    return code;
}
