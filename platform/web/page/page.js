// The page starts: words are filled in, and each part begins to listen. What the parts share is in
// model.js; words.js has all text, server.js all questions to the server.
import { startAdjust } from './adjust.js';
import { $ } from './dom.js';
import { startLive } from './live.js';
import { startLooks } from './looks.js';
import { listen, model, setTab } from './model.js';
import { startOpening } from './opening.js';
import { startPainting } from './painting.js';
import { startRack } from './rack.js';
import { startSaving } from './saving.js';
import { startViewer } from './viewer.js';
import { fillIn } from './words.js';

/** Tabs: arrow keys go from one to the next, as in every row of tabs. */
function startTabs() {
    const tabs = [...$('tabs').children];
    const names = tabs.map((tab) => tab.getAttribute('aria-controls'));

    $('tabs').addEventListener('keydown', (event) => {
        const seen = tabs.filter((tab) => !tab.hidden);
        const at = seen.indexOf(event.target), last = seen.length - 1;
        const to = { ArrowLeft: at === 0 ? last : at - 1, ArrowRight: at === last ? 0 : at + 1,
            Home: 0, End: last }[event.key];
        if (to === undefined)
            return;
        event.preventDefault();
        seen[to].focus();
        seen[to].click();
    });
    tabs.forEach((tab, i) => tab.addEventListener('click', () => setTab(names[i])));
    listen(() => tabs.forEach((tab, i) => {
        const chosen = names[i] === model.tab;
        tab.setAttribute('aria-selected', chosen);
        tab.tabIndex = chosen ? 0 : -1;
        $(names[i]).hidden = !chosen;
    }));
}

fillIn(document);
startViewer();
startTabs();
startAdjust();
startLooks();
startPainting();
startRack();
startSaving();
startLive();
startOpening();
$('unscripted').remove();
