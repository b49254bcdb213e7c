/* browser.c: the page is opened in a browser. */
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include "serve/browser.h"

/* A session of its own: Ctrl-C ends the server alone, and what a browser says is not heard. */
static void become_browser(const char *link)
{
    const char *const browser = getenv("BROWSER");
    const int nothing = open("/dev/null", O_RDWR);
    sigset_t none;

    setsid();
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGPIPE, SIG_DFL);
    for (int i = 0; i < 3; i++)
        dup2(nothing, i);
    if (browser && *browser)
        execlp(browser, browser, link, (char *)NULL);
    execlp("xdg-open", "xdg-open", link, (char *)NULL);
}

/* The process between ends at once, so that nobody has to wait for the browser. */
void browser_open(const char *link)
{
    const pid_t child = fork();

    if (child == 0) {
        if (fork() == 0)
            become_browser(link);
        _exit(0);
    }
    if (child > 0)
        waitpid(child, NULL, 0);
}
