# Runs the vehicle under skyhook and leaves an animated picture of two seconds: ./trackvib exec -- sh moving_picture.sh
set -e
python -m trackvib_sim.cli run --law skyhook --duration 5 --out moving
python -m trackvib_sim.cli view moving/bag --gif view.gif --start 3 --end 5
