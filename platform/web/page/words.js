// All English text of the page. {name} stands for a value that say() puts in.
const words = {
    title: 'refocus',
    titleOf: '{name} – refocus',

    // opening
    open: 'Open',
    openTitle: 'Open a photo',
    openHint: 'Drop a photo here, or choose one. Photos with depth refocus at once; for others ' +
        'you paint the depth.',
    depthHint: 'Depth of a map, or of two views, comes into a photo by the command “refocus depth ' +
        'PHOTO --depth MAP -o NEW.jpg”, or with --stereo-file.',
    choose: 'Choose a photo…',
    folder: 'In this folder',
    folderEmpty: 'There are no photos in this folder.',
    unnamed: 'Files that are left out as their names hold a backslash, a control character or what ' +
        'is not UTF-8: {n}. Give them other names.',
    back: 'Back to the photo',
    live: 'Live view',
    capture: 'Capture',
    capturing: 'Capturing…',
    openedLive: 'Live: tap what should be sharp.',
    withDepth: 'depth',
    withoutDepth: 'no depth',
    photoWith: '{name}, with depth',
    photoWithout: '{name}, without depth',
    opening: 'Opening {name}…',
    sending: 'Sending {name}… To give it up, open another photo.',
    givenUp: '{name} is not sent any more.',
    stillOpening: '{name} is still being opened.',
    opened: '{name}: tap what should be sharp.',
    openedFlat: '{name} has no depth yet. Paint it: the ground first, then what stands on it.',
    dropHere: 'Drop the photo to open it',
    noPhoto: 'That is no photo.',
    tooLarge: '{name} is too large: this server takes up to {n} MiB.',
    openedAgain: '{name} is open again, as it was.',
    failsAlways: 'The process of {name} fails again and again, perhaps for want of memory.',
    quickAlone: '{name} is open again, by quick pictures alone: its process has failed twice, ' +
        'perhaps for want of memory. To try full ones, open it anew.',

    // the picture
    stage: 'Photo',
    stageHelp: 'Tap to focus, pinch to zoom; two fingers up or down tilt what is in focus. Arrow keys move a cross, Enter focuses there. Plus and minus zoom, 0 fits, ' +
        '1 shows full size, B shows before and after.',
    stagePaintHelp: 'Arrow keys move a cross, Enter puts the brush down and lifts it. Plus and ' +
        'minus zoom, 0 fits, 1 shows full size.',
    compare: 'Before / after',
    divider: 'Divider between before and after',
    dividerAt: '{n} percent before',
    before: 'Before',
    after: 'After',
    view: 'Show',
    viewPicture: 'Photo',
    viewDepth: 'Depth',
    viewBlur: 'Blur',
    viewPeaking: 'Sharp edges',
    zoom: 'Zoom',
    zoomIn: 'Zoom in',
    zoomOut: 'Zoom out',
    fit: 'Fit',
    fullSize: '1:1',
    focused: 'Focus set.',

    // tabs
    tools: 'Tools',
    tabAdjust: 'Adjust',
    tabLook: 'Look',
    tabPaint: 'Paint depth',
    tabPull: 'Rack focus',

    // adjusting
    focus: 'Focus',
    focusAt: '{n} %',
    far: 'far',
    near: 'near',
    aperture: 'Aperture',
    blur: 'Blur',
    sharp: 'sharp',
    soft: 'soft',
    fNumber: 'f/{n}',
    pixels: '{n} px',
    highlights: 'Highlights',
    highlightsAt: '×{n}',
    off: 'off',
    most: 'bright',
    auto: 'Auto',
    autoValue: 'auto',
    autoName: 'Highlights as the photo tells',
    band: 'Band in focus',
    bandAt: '± {n} %',
    thin: 'thin',
    deep: 'deep',
    tilt: 'Tilt',
    tiltAt: '{n}°',
    turn: 'Turn of the tilt',
    reset: 'Reset all',
    resetDone: 'All as it was when the photo was opened.',

    // looks and the shape of the aperture
    looks: 'Look',
    shapes: 'Aperture shape',
    shapePolygon: '{n} blades',
    shape: { look: 'of the look', disc: 'round', heart: 'heart', star: 'star' },
    look: {
        plain: 'Plain', classic: 'Classic', smooth: 'Smooth', bubble: 'Bubble', ring: 'Ring',
        swirl: 'Swirl', cine: 'Cine', vintage: 'Vintage', heart: 'Heart', star: 'Star',
        sparkle: 'Sparkle', portrait: 'Portrait', 'close-up': 'Close-up', night: 'Night',
        cinema: 'Cinema', mirror: 'Mirror lens', draft: 'Draft', paper: 'Paper',
    },

    // painting
    brush: 'Brush',
    ground: 'Ground',
    object: 'Object',
    gradient: 'Slope',
    more: 'More',
    less: 'Less',
    groundHelp: 'Draw a line from the nearest ground to the farthest.',
    objectHelp: 'Rub over an object. It is found up to its edge.',
    gradientHelp: 'Draw a line over the last object: its depth runs along it.',
    moreHelp: 'Rub over what the last object lacks.',
    lessHelp: 'Rub over what the last object has too much.',
    size: 'Brush size',
    depth: 'Depth',
    depthStart: 'Depth where the line begins',
    depthEnd: 'Depth where it ends',
    undo: 'Undo',
    redo: 'Redo',
    strokes: 'Strokes',
    strokesNone: 'Nothing painted yet.',
    strokeAt: '{n}. {kind}',
    backTo: 'Back to stroke {n}, {kind}',
    forthTo: 'Forth to stroke {n}, {kind}',
    penDown: 'Brush down.',
    painted: '{kind} painted.',
    strokesAgain: '{name}: the strokes from before are there again.',
    undone: 'Undone.',
    redone: 'Redone.',

    // rack focus
    pullHelp: 'Focus on something and mark it, then on something else and mark that.',
    mark: 'Mark this focus',
    keys: 'Key frames',
    goTo: 'Show key frame {n}',
    secondsTo: 'Seconds to key frame {n}',
    seconds: 's',
    start: 'start',
    remove: 'Remove key frame {n}',
    marked: 'Key frame {n} marked.',
    removed: 'Key frame {n} removed.',
    play: 'Play',
    stop: 'Stop',
    time: 'Time',
    timeAt: '{n} s',
    savePull: 'Save as {format}',
    pullMost: 'A rack focus takes {n} seconds at the most.',
    pullWaits: 'Making the {format}. This takes a while…',
    format: { gif: 'GIF', apng: 'animated PNG', mp4: 'MP4 video', webm: 'WebM video' },

    // saving
    save: 'Save',
    saveJpeg: 'JPEG, stays editable',
    saveJpegMore: 'keeps the original and its depth inside',
    savePng: 'PNG',
    savePngMore: 'without loss',
    saveSettings: 'Settings',
    saveSettingsMore: 'for refocus render --settings',
    saveDepth: 'Depth map',
    saveDepthMore: 'a grey picture, bright is near',
    link: 'Copy the link',
    linkMore: 'opens this photo with these settings',
    linkCopied: 'The link is copied.',
    linkShown: 'Copy this link:',
    saving: 'Saving…',
    saved: 'Saved {name}.',

    // errors
    unreachable: 'The server does not answer. Is refocus serve still running?',
    cutOff: 'The way to the server broke off before all of {name} was sent. If refocus ' +
        'serve is still running, try again.',
    refused: 'The server refused that ({status}).',
    anew: 'The server was started anew: open its new link.',
};

/** The text of a key such as 'open' or 'look.plain', with values; undefined when there is none. */
export function say(key, values = {}) {
    const text = key.split('.').reduce((at, name) => at?.[name], words);
    return text?.replace(/\{(\w+)\}/g, (_, name) => values[name]);
}

/** Fill in the text of the elements that name theirs: data-word is the text, data-label the name
 * for a screen reader. */
export function fillIn(root) {
    for (const element of root.querySelectorAll('[data-word]'))
        element.textContent = say(element.dataset.word);
    for (const element of root.querySelectorAll('[data-label]'))
        element.setAttribute('aria-label', say(element.dataset.label));
}
