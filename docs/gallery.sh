#!/usr/bin/env bash
# Draws the pictures of the gallery, and writes its page: docs/gallery.sh path/to/crosscap (takes minutes).
# A line: name of the picture, title, options of `sample`, options of `reconstruct`, what there is to see.
set -euo pipefail
crosscap=$(realpath "${1:-crosscap}")
docs=$(cd "$(dirname "$0")" && pwd)
page=$docs/src/gallery.md
pictures=$docs/src/images/gallery
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$pictures"
cd "$work"

cat > "$page" <<'END'
# Gallery

Every picture is made by the two commands beside it; `--picture name.html` instead gives a page to turn. Colors are pieces, double curves and junctions
black or dark, boundaries dark blue. The numbers are the Betti numbers over Q. `docs/gallery.sh` makes this page.

END

while IFS='|' read -r name title sample reconstruct told; do
    [ -n "$name" ] || continue
    echo "$name"
    # shellcheck disable=SC2086
    "$crosscap" sample $sample --seed 1 -o "$name.npy" > /dev/null 2>&1
    # shellcheck disable=SC2086
    if ! "$crosscap" reconstruct "$name.npy" -o "$name.npz" $reconstruct > /dev/null 2>&1; then
        echo "$name: no verified mesh" >&2
        exit 1
    fi
    "$crosscap" view "$name.npz" -o "$pictures/$name.png" --size 480x360 > /dev/null 2>&1
    betti=$("$crosscap" check "$name.npz" --json 2> /dev/null | tr -d ' \n' | sed 's/.*"betti_rational":\[\([0-9,]*\)\].*/\1/; s/,/, /g' || true)
    cat >> "$page" <<END
## $title

![$title](images/gallery/$name.png)

${told^}. Betti numbers $betti.

\`\`\`sh
crosscap sample $sample --seed 1 -o $name.npy
crosscap reconstruct $name.npy -o $name.npz${reconstruct:+ $reconstruct} --picture $name.png
\`\`\`

END
done < "$docs/gallery.txt"
