# Sourced by gallery.sh: makes gallery.html and its pictures, examples/gallery/page-*.jpg, with the
# command alone. Each picture is the command that is written below it, with --quality best.

page_width=640
page_options=(--resize $page_width --jpeg-quality 82 --strip)

# page_begin FOLDER: of the page; its pictures lie in FOLDER/gallery
page_begin() {
    page=$1
    page_number=0
    mkdir -p "$page/gallery"
    rm -f "$page"/gallery/page-*.jpg
    cat > "$page/gallery.html" <<'EOF'
<!DOCTYPE html>
<!-- Made by examples/gallery.sh BUILD page. -->
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>librefocus: focus after the shot</title>
<style>
:root { color-scheme: light dark; --text: #1c1c1c; --paper: #fafafa; --quiet: #555; --code: #ececec; }
@media (prefers-color-scheme: dark) {
    :root { --text: #e8e8e8; --paper: #161616; --quiet: #b0b0b0; --code: #262626; }
}
body { margin: 0; padding: 1rem; font: 1rem/1.5 system-ui, sans-serif; color: var(--text); background: var(--paper); }
header, main { max-width: 84rem; margin: 0 auto 1.5rem; }
main { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 2rem 1.5rem; }
h1 { line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.1rem; margin: .5rem 0 0; }
p { margin: .25rem 0; max-width: 44rem; }
figure { margin: 0; min-width: 0; }
.pair { position: relative; line-height: 0; --at: 35%; overflow: hidden; border-radius: .4rem; }
.pair img { width: 100%; height: auto; display: block; }
.pair img + img { position: absolute; inset: 0; height: 100%; clip-path: inset(0 0 0 var(--at)); }
.pair::after { content: ""; position: absolute; top: 0; bottom: 0; left: calc(var(--at) - 1px); width: 2px; background: #fff; box-shadow: 0 0 3px #000; pointer-events: none; }
.knob { position: absolute; top: 50%; left: var(--at); width: 2.75rem; height: 2.75rem; margin: -1.375rem; border-radius: 50%; background: rgba(255, 255, 255, .85); box-shadow: 0 0 4px #000; color: #222; font: 1.2rem/2.75rem system-ui, sans-serif; text-align: center; pointer-events: none; z-index: 1; }
.pair input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; touch-action: pan-y; }
.pair:focus-within { outline: 3px solid #3b82f6; outline-offset: 2px; }
figcaption p { color: var(--quiet); }
code { display: block; margin-top: .4rem; padding: .4rem .6rem; font: .85rem/1.4 ui-monospace, monospace; background: var(--code); border-radius: .3rem; overflow-wrap: anywhere; }
code span { display: inline-block; max-width: 100%; }
</style>
</head>
<body>
<header>
<h1>librefocus: focus after the shot</h1>
<p>One photo that is sharp everywhere and its depth map become the photo of a wide lens, focused where
you like. Left of each line: as photographed. Right of it: refocused. Drag the line, or use the arrow keys.</p>
</header>
<main>
EOF
}

# page_photo SCENE: as photographed, once a scene
page_photo() {
    [ -e "$page/gallery/page-$1.jpg" ] ||
        "$build/platform/cli/refocus" render "$top/examples/data/$1/allfocus.png" \
            --depth "$top/examples/data/$1/disparity.png" --focus 0 --blur 0 --highlights off \
            "${page_options[@]}" -o "$page/gallery/page-$1.jpg"
}

# page_show SCENE TITLE WORDS OPTIONS...
page_show() {
    local scene=$1 title=$2 words=$3 name command
    shift 3
    command="refocus render $scene/allfocus.png --depth $scene/disparity.png $* -o out.jpg"
    command="<span>${command// -/</span> <span>-}</span>" # lines are not to break at hyphens
    page_number=$((page_number + 1))
    name=$(printf 'page-%02d.jpg' $page_number)
    page_photo "$scene"
    "$build/platform/cli/refocus" render "$top/examples/data/$scene/allfocus.png" \
        --depth "$top/examples/data/$scene/disparity.png" --quality best "$@" \
        "${page_options[@]}" -o "$page/gallery/$name"
    cat >> "$page/gallery.html" <<EOF
<figure>
<div class="pair">
<img src="gallery/page-$scene.jpg" width="$page_width" height="$((page_width * 3 / 4))" alt="As photographed: all of it is sharp.">
<img src="gallery/$name" width="$page_width" height="$((page_width * 3 / 4))" alt="$title. $words">
<span class="knob" aria-hidden="true">&#8646;</span>
<input type="range" min="0" max="100" step="1" value="35" aria-label="$title: how much is shown as photographed">
</div>
<figcaption><h2>$title</h2><p>$words</p>
<code>$command</code></figcaption>
</figure>
EOF
    ls "$page/gallery/$name"
}

page_end() {
    cat >> "$page/gallery.html" <<'EOF'
</main>
<script>
for (const line of document.querySelectorAll('.pair input')) {
    const place = () => line.parentElement.style.setProperty('--at', line.value + '%');
    line.addEventListener('input', place);
    place();
}
</script>
</body>
</html>
EOF
    ls "$page/gallery.html"
}

# page_all FOLDER
page_all() {
    page_begin "$1"
    page_show portrait 'The person' 'The wall behind and the leaves in front are soft; single hairs stay sharp.' \
        --focus 0.689 --blur 20
    page_show portrait 'The far wall' 'The same photo: the person is before the focus now, and melts over what is behind.' \
        --focus 0 --blur 20
    page_show fence 'Through the fence' 'Wires before the focus become so wide that the view behind them opens.' \
        --focus 0.243 --blur 40
    page_show tabletop 'Close up' 'The nearest things on the table, by a lens that is wide open.' \
        --focus 0.916 --blur 24
    page_show nightlights 'Lights at night' 'Lights become discs, with the brightness that the 8 bits of the photo had clipped.' \
        --focus 0.966 --blur 22
    page_show nightlights 'Hearts' 'The aperture may have any shape.' \
        --focus 0.966 --blur 22 --bokeh heart
    page_show nightlights 'Six blades' 'The iris of a lens that is stopped down.' \
        --focus 0.966 --blur 22 --aperture polygon:6:90
    page_show nightlights 'Swirl' 'Discs become narrow towards the corners and turn around the middle, as by old portrait lenses.' \
        --focus 0.966 --blur 22 --bokeh swirl
    page_show portrait 'Two bands in focus' 'The person and the far wall are sharp at once, and the leaves before them are not: no lens does that.' \
        --focus 0.689 --focus-width 0.03 --also-focus 0.02:0.03 --blur 20
    page_show portrait 'Miniature' 'A plane of focus that is tilted, so that mostly the place in the picture decides.' \
        --focus 0.689 --blur 28 --tilt-line 0,160,719,160 --tilt-angle 65 --tilt-compress 0.9
    page_end
}
