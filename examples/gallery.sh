#!/usr/bin/env bash
# usage: gallery.sh BUILD [page [FOLDER]]
# Makes the pictures of examples/gallery.md from the two scenes in examples/data: tilt-shift, two
# focus bands, a field of blur, a focus pull, bokeh on night lights, sigma. Needs ImageMagick to crop and to put
# pictures side by side. Then the page gallery.html, or with `page` that alone, here or in FOLDER, which needs
# nothing but the command.
set -eu -o pipefail
[ $# -ge 1 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(cd "$1" && pwd)
out=$top/examples/gallery
. "$top/examples/gallery_page.sh"
if [ "${2-}" = page ]; then
    page_all "${3-$top/examples}"
    exit
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

# shoot SCENE NAME OPTIONS...
shoot() {
    local scene=$top/examples/data/$1 name=$2
    shift 2
    "$build/platform/cli/refocus" render "$scene/allfocus.png" --depth "$scene/disparity.png" \
        --quality best -o "$work/$name.png" "$@"
}

# save NAME CROP SIZE PICTURES...: side by side
save() {
    local name=$1 crop=$2 size=$3
    shift 3
    convert "${@/#/$work/}" -crop "$crop" +repage -filter Lanczos -resize "$size" \
        -bordercolor white -border 2x0 +append -strip -quality 88 "$out/$name.jpg"
    ls "$out/$name.jpg"
}

portrait=720x540+0+0 lights=420x280+280+50
cp "$top/examples/data/portrait/allfocus.png" "$work/sharp.png"

shoot portrait plain --focus 0.689 --blur 20
shoot portrait tilt --focus 0.689 --blur 28 --tilt-line 0,160,719,160 --tilt-angle 65 \
    --tilt-compress 0.9
save tilt-shift $portrait 400x300 sharp.png plain.png tilt.png

shoot portrait one --focus 0.689 --blur 20
shoot portrait two --focus 0.689 --focus-width 0.03 --also-focus 0.02:0.03 --blur 20
save two-bands $portrait 400x300 one.png two.png

shoot portrait plus --field plus --field-at 400,235 --field-disparity 0.689 --field-radius 0.06 \
    --field-falloff 0.2 --blur 20
save plus $portrait 400x300 sharp.png plus.png

"$build/platform/cli/refocus" pull "$top/examples/data/portrait/allfocus.png" \
    --depth "$top/examples/data/portrait/disparity.png" --quality best --blur 20 --from 1 --to 0 \
    --seconds 1 --fps 4 -o "$work/pull-%d.png"
save pull $portrait 240x180 pull-0.png pull-1.png pull-2.png pull-3.png pull-4.png

night() {
    shoot nightlights "$@" --focus 0.966 --blur 22
}
night disc
night heart --bokeh heart
save heart $lights 400x267 disc.png heart.png
night six --aperture polygon:6:90
save six-blades $lights 400x267 disc.png six.png
night cat --cat-eye 0.75
save cat-eye 720x400+0+0 400x222 disc.png cat.png

for preset in classic smooth bubble ring swirl cine vintage star; do
    night $preset --bokeh $preset
done
save presets-1 $lights 300x200 classic.png smooth.png bubble.png ring.png
save presets-2 $lights 300x200 swirl.png cine.png vintage.png star.png
shoot nightlights sparkle --bokeh sparkle --focus-at 255,177 --blur 10
save sparkle $lights 400x267 sparkle.png

for sigma in off 400 200 100; do
    night sigma$sigma --sigma $sigma --highlights off
done
save sigma $lights 300x200 sigmaoff.png sigma400.png sigma200.png sigma100.png
for blend in stored gamma linear; do
    night blend$blend --blend $blend --sigma off --highlights off
done
night lamps --sigma off --highlight-stops 3
save averaging $lights 300x200 blendstored.png blendgamma.png blendlinear.png lamps.png

page_all "$top/examples"
