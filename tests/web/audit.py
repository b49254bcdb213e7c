"""Checks in the browser of the needs that everybody has: names, contrast, sizes to touch, a focus
that shows, nothing cut off. Each check returns the lines that it complains about."""
import os

SHARED = '''
const seen = (element) => element.checkVisibility({ visibilityProperty: true }) &&
    element.getClientRects().length > 0 && !element.closest('.unseen:not(input)');
const controls = () => [...document.querySelectorAll(
    'button, a[href], input, [role=slider], [tabindex="0"]')].filter(seen);
const told = (element) => `${element.tagName.toLowerCase()}#${element.id || element.value || ''} ` +
    `"${(element.getAttribute('aria-label') ?? element.textContent).trim().slice(0, 30)}"`;
/* A radio button is drawn, and touched, by its label. */
const touched = (element) => element.type === 'radio' ? element.closest('label') : element;
const rgba = (text) => {
    const c = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
    c.fillStyle = text;
    c.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = c.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
};
const blend = (over, under) => over.slice(0, 3)
    .map((v, i) => v * over[3] + under[i] * (1 - over[3]));
const light = (colour) => {
    const [r, g, b] = colour.map((v) => (v /= 255) <= 0.04045 ? v / 12.92
        : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const ratio = (a, b) => {
    const [low, high] = [light(a), light(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
};
/* Grounds that an element may have: over a picture both black and white. */
const grounds = (element) => {
    const layers = [];
    let bases = [[255, 255, 255]];
    for (let at = element; at; at = at.parentElement) {
        const colour = rgba(getComputedStyle(at).backgroundColor);
        if (at.id === 'stage') {
            bases = [[0, 0, 0], [255, 255, 255], colour];
            break;
        }
        if (colour[3] > 0)
            layers.unshift(colour);
        if (colour[3] === 1)
            break;
    }
    return bases.map((base) => layers.reduce((under, over) => blend(over, under), base));
};
'''

SIZES = SHARED + '''
return controls().map((element) => [element, touched(element).getBoundingClientRect()])
    .filter(([element, box]) => box.height < 43.5 || box.width < 43.5)
    .map(([element, box]) => `${told(element)} is ${box.width} x ${box.height}`);
'''

CONTRAST = SHARED + '''
const found = [], walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walk.nextNode()) {
    const element = walk.currentNode.parentElement;
    if (!walk.currentNode.data.trim() || !seen(element) ||
            element.closest(':disabled, label:has(:disabled)'))
        continue;
    const colour = rgba(getComputedStyle(element).color);
    for (const ground of grounds(element)) {
        const is = ratio(blend(colour, ground), ground);
        if (is < 4.5)
            found.push(`${told(element)} has contrast ${is.toFixed(2)}`);
    }
}
/* The edge of what is touched, where its ground alone does not show it. */
for (const element of controls().map(touched)) {
    const style = getComputedStyle(element);
    if (element.matches(':disabled, :has(:disabled), .card, [role=tab], [role=slider]') ||
            style.borderTopStyle === 'none' || parseFloat(style.borderTopWidth) === 0 ||
            element.closest('#save-menu, #looks, #shapes'))
        continue;
    for (const ground of grounds(element.parentElement)) {
        const is = Math.max(ratio(blend(rgba(style.borderTopColor), ground), ground),
            ratio(grounds(element)[0], ground));
        if (is < 3)
            found.push(`${told(element)} has an edge of contrast ${is.toFixed(2)}`);
    }
}
return found;
'''

CUT_OFF = SHARED + '''
const found = [], root = document.documentElement;
if (root.scrollWidth > innerWidth || document.body.scrollHeight > innerHeight + 1)
    found.push(`the page is ${root.scrollWidth} x ${document.body.scrollHeight}`);
for (const element of document.querySelectorAll('button, label, h2, output, small')) {
    if (!seen(element) || element.closest('.photo'))
        continue;
    if (element.scrollWidth > element.clientWidth + 1 && element.clientWidth > 0)
        found.push(`${told(element)} is ${element.scrollWidth} wide in ${element.clientWidth}`);
    const box = element.getBoundingClientRect();
    if (box.left < -0.5 || box.right > innerWidth + 0.5)
        found.push(`${told(element)} reaches from ${box.left} to ${box.right}`);
}
return found;
'''

FOCUS = SHARED + '''
const element = document.activeElement;
if (element === document.body || !element)
    return null;
const style = getComputedStyle(touched(element));
return { what: told(element), id: element.id, value: element.value ?? '',
    shows: style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2 };
'''

# Controls that Tab should come to: of radio buttons and tabs one each.
TABBED = SHARED + '''
return controls().filter((element) => !element.disabled && element.tabIndex === 0 &&
    (element.type !== 'radio' || element.checked || !document.querySelector(
        `input[name="${element.name}"]:checked`))).map(told);
'''

ROLES = ('button', 'slider', 'radio', 'tab', 'spinbutton', 'textbox', 'application', 'tablist',
         'radiogroup', 'tabpanel', 'group')


def sizes(browser):
    return browser.run(SIZES)


def contrast(browser):
    return browser.run(CONTRAST)


def cut_off(browser):
    return browser.run(CUT_OFF)


def names(browser):
    """Roles without a name, as a screen reader gets them."""
    nodes = browser.command('Accessibility.getFullAXTree')['nodes']
    roles = [(node['role']['value'], node.get('name', {}).get('value', '')) for node in nodes
             if not node['ignored'] and 'role' in node]
    found = ['a %s without a name' % role for role, name in roles
             if role in ROLES and not name.strip()]
    return found if any(role == 'button' for role, _ in roles) else ['no button at all']


AXE = '''
const done = arguments[arguments.length - 1];
axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] })
    .then((result) => done(result.violations.flatMap((rule) => rule.nodes.map((node) =>
        `axe ${rule.id}: ${node.target.join(' ')} ${node.failureSummary.slice(0, 200)}`))),
    (error) => done([`axe: ${error}`]));
'''


def axe(browser):
    """The rules of axe-core, whose axe.min.js REFOCUS_AXE names; nothing without it."""
    file = os.environ.get('REFOCUS_AXE')
    if not file:
        return []
    with open(file) as script:
        browser.driver.execute_script(script.read())
    return browser.driver.execute_async_script(AXE)


def all_of_them(browser):
    return sizes(browser) + contrast(browser) + cut_off(browser) + names(browser) + axe(browser)
