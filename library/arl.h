/* A compiled ARL program as a library: `arl2rs build --library pick.arl` makes one.
 *
 * Load it, and ask for its interface:
 *
 *     const ArlInterface *arl = ((ArlInterface *(*)(void))dlsym(library, "arl_interface"))();
 *
 * It must not be unloaded. Runs do not disturb each other; each has one thread, that which began it, with 2 MiB of
 * stack or more, and none of them outlives a fork. What takes a text calls nothing of this interface. Texts are UTF-8
 * and not ended by 0, but for those that are given in; one without characters may have any pointer. */
#ifndef ARL_H
#define ARL_H

#include <stddef.h>
#include <stdint.h>

/* The version of what is described here. What has another version has another shape. */
#define ARL_INTERFACE 3

/* What `go_on` answers beside the exit code of a run that is over: 0 ended, 3 alarm, 4 out of time, 130 stopped. */
#define ARL_RUNS (-1)         /* It goes on. */
#define ARL_BROKEN (-2)       /* The run has panicked; the standard error says why. It can only be ended. */
#define ARL_WRONG_THREAD (-3) /* This is not the thread of the run. Nothing was done. */

/* What answers 0 where something was done answers 1 where it is refused, and tells the reason; the last two come without
 * one. */

/* A run of the program. */
typedef struct ArlRun ArlRun;

/* Takes a text; `context` is what was given with it. The text is there as long as the call lasts. */
typedef void (*ArlTake)(void *context, const char *text, size_t length);

typedef struct {
    uint32_t version; /* ARL_INTERFACE */
    uint32_t columns; /* how many doubles a row of the trace has */

    /* A run at the start of its first cycle. `arguments` are `count` words as on a command line, each ended by 0:
     * "--robot", "six-10". With `traced` not 0 it keeps the trace of the first robot. Without "--state-dir" nothing that a
     * program keeps outlives the run. NULL: `why` was told the reason. */
    ArlRun *(*begin)(const char *const *arguments, size_t count, int32_t traced, ArlTake why, void *context);

    /* Goes on for so many cycles, or until the run is over. With `alone` not 0 nobody else changes anything, so that
     * programs that all wait in vain end it. */
    int32_t (*go_on)(ArlRun *run, uint64_t cycles, int32_t alone);

    /* Ends the programs: robots stop on their paths within the cycles that follow. Any thread may call it, also while the
     * run's own is in `go_on`. */
    void (*stop)(const ArlRun *run);

    /* Does what an event of a scenario does: "di.5 = true". 0: it was done; else `why` was told the reason. */
    int32_t (*order)(ArlRun *run, const char *text, ArlTake why, void *context);

    /* What was said since the last call, and is kept until then: messages, warnings, alarms, a JSON object a line. */
    void (*said)(ArlRun *run, ArlTake take, void *context);

    /* How everything stands, a JSON object. */
    void (*state)(ArlRun *run, ArlTake take, void *context);

    /* The rows of the trace since the last call, kept until then: doubles as bytes, `columns` of them a row. Where "--trace-columns"
     * and "file" are among the arguments there is one more behind each row: which of `files` its line is of, from 0; no number
     * where no motion is executed. */
    void (*rows)(ArlRun *run, ArlTake take, void *context);

    /* Controller time in s. */
    double (*time)(const ArlRun *run);

    /* Ends the run: a robot that moves is cut off. The pointer is not valid any more. From another thread nothing happens. */
    void (*end)(ArlRun *run);

    /* The names of the columns of the trace, with commas between. */
    void (*header)(ArlTake take, void *context);

    /* What came of the run, or how far it is, a JSON object: outcome, exit code, cycle time in s, alarms; with "--report" also
     * what the motions of the first robot were together. */
    void (*summary)(ArlRun *run, ArlTake take, void *context);

    /* What each motion did, a JSON object a line, where "--report" is among the arguments. */
    void (*report)(ArlRun *run, ArlTake take, void *context);

    /* What `observe` tells beside the row of the trace, a name a line: "do.1\nglobal.placed". 0: so it is; else `why` was told
     * the reason, and nothing changed. */
    int32_t (*watch)(ArlRun *run, const char *names, ArlTake why, void *context);

    /* Fills in the last cycle's row of the trace, then what is watched, and no more than `count` doubles; how many there are. */
    size_t (*observe)(ArlRun *run, double *numbers, size_t count);

    /* The value of a global variable, as a literal of ARL. 0: `take` has it; else the reason why not. */
    int32_t (*global)(ArlRun *run, const char *name, ArlTake take, void *context);

    /* Gives a global variable a value; components that the literal leaves out keep theirs. 0: so it is; else `why` was told the
     * reason. */
    int32_t (*set_global)(ArlRun *run, const char *name, const char *literal, ArlTake why, void *context);

    /* The names of the files that rows of the trace have named so far, one a line. */
    void (*files)(ArlRun *run, ArlTake take, void *context);
} ArlInterface;

#endif
