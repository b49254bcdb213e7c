/* browser.h: the page is opened in a browser. */
#ifndef RF_CLI_SERVE_BROWSER_H
#define RF_CLI_SERVE_BROWSER_H

/* Hand the link to the program that $BROWSER names, else to xdg-open; where there is neither,
 * nothing happens. The process may have no other threads. */
void browser_open(const char *link);

#endif
