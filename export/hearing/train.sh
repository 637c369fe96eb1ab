#!/bin/sh
# train.sh - trains the bundled networks of hearing, as docs/hearing.md tells, which says what the folders have.
#
#     sh export/hearing/train.sh TALKERS LJ KATHLEEN OUT
#
# TALKERS has sounds with a .txt beside each, LJ a metadata.csv and its wavs, KATHLEEN the repository's data folder. OUT
# is a new folder. Needs Labial with the extra hear, flite, festival with festvox-kallpc16k and festvox-us-slt-hts, and espeak-ng.
set -eu
talkers=$1 lj=$2 kathleen=$3 out=$4
here=$(dirname "$0")
mkdir "$out"

labial speech-corpus "$out/espeak" --minutes 50 --sentences "$lj/metadata.csv" "$talkers"/*.txt --voices \
    espeak:en-us espeak:en-us+f2 espeak:en-us+klatt espeak:en-us+m3 espeak:en+f4 espeak:en-us+Andy espeak:en-us+m5 \
    espeak:en-029+f1 espeak:en-us+klatt2 espeak:en-gb-scotland+m2 espeak:en-us+anika espeak:en-us-nyc+m7 \
    espeak:en-us+klatt3 espeak:en-gb-x-rp+f3 espeak:en-us+linda espeak:en-us+adam espeak:en-us+belinda \
    espeak:en-us+m1 espeak:en-us+whisper espeak:en-us+steph espeak:en-us+grandpa
labial speech-corpus "$out/flite" --minutes 55 --sentences "$lj/metadata.csv" "$talkers"/*.txt --voices \
    flite:slt flite:rms flite:kal16 festival:kal_diphone festival:cmu_us_slt_arctic_hts
mkdir "$out/languages"
for language in es fr it pt ru hi ja cmn de nl; do
    sed -n "s/^$language|//p" "$here/languages.txt" >"$out/$language.txt"
    labial speech-corpus "$out/languages/$language" --minutes 4 --sentences "$out/$language.txt" --voices \
        "espeak:$language" "espeak:$language+f2" "espeak:$language+m3" "espeak:$language+klatt" "espeak:$language+f4" \
        "espeak:$language+m7"
done

train() {
    labial train-hear "$talkers" "$out/espeak" "$out/flite" "$lj" "$kathleen" --cache "$out/cache" \
        --takes 8,3,3,4,4 --shares .40,.18,.18,.10,.14 --smoothness 3 --attribution-file "$here/attribution.txt" "$@"
}
train --model small --steps 45000 -o "$out/first_small.npz"
train --model large --steps 38000 -o "$out/first_large.npz"

# The network that looks ahead begins with the large one; it teaches the others, which also hear sound without a text.
labial train-hear "$talkers" "$out/espeak" "$out/flite" "$lj" "$kathleen" "$out/languages" --cache "$out/cache" \
    --takes 5,2,3,2,2,2 --shares .40,.15,.15,.09,.11,.10 --smoothness 3 --attribution-file "$here/attribution.txt" \
    --model ahead --start "$out/first_large.npz" --rate .0012 --steps 10800 -o "$out/hear_ahead.npz"
taught() {
    labial train-hear "$talkers" "$out/espeak" "$out/flite" "$lj" "$kathleen" "$out/languages" --cache "$out/cache" \
        --takes 5,2,3,2,2,2,1,1 --shares .37,.13,.13,.07,.08,.10,.05,.07 --smoothness 3 \
        --attribution-file "$here/attribution.txt" --teacher "$out/hear_ahead.npz" --sounds "$lj" "$kathleen" "$@"
}
taught --model host --start "$out/hear_ahead.npz" --rate .001 --steps HOST -o "$out/hear_host.npz"
taught --model large --start "$out/first_large.npz" --rate .0012 --steps LARGE -o "$out/hear_large.npz"
taught --model small --start "$out/first_small.npz" --rate .0012 --steps SMALL -o "$out/hear_small.npz"
