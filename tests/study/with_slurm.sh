#!/bin/sh
# with_slurm.sh FOLDER COMMAND…: runs the command beside a Slurm of one node on the loopback interface, whose files all
# lie in FOLDER, and ends it by its pid files. As root; slurm-wlm and munge.
set -u
dir=$1
shift
mkdir -p "$dir/state" "$dir/spool"
chmod 755 "$dir"
port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
host=$(hostname -s)
cat > "$dir/slurm.conf" <<END
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
SlurmctldPort=$(port)
SlurmdPort=$(port)
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
MpiDefault=none
ReturnToService=2
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=2
PartitionName=all Nodes=$host Default=YES State=UP
END
export SLURM_CONF="$dir/slurm.conf"
end() {
  for name in slurmd slurmctld munged; do
    [ -s "$dir/$name.pid" ] || continue
    pid=$(cat "$dir/$name.pid")
    kill "$pid" 2> /dev/null
    while kill -0 "$pid" 2> /dev/null; do sleep 0.1; done
  done
}
trap end EXIT
head -c 1024 /dev/urandom > "$dir/munge.key"
chmod 400 "$dir/munge.key"
munged --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" \
  --log-file="$dir/munged.log" --seed-file="$dir/munge.seed" || exit 97
slurmctld > /dev/null 2>&1 || exit 98
slurmd > /dev/null 2>&1 || exit 99
tries=0
until sinfo --noheader --format %t 2> /dev/null | grep -q idle; do
  tries=$((tries + 1))
  [ $tries -gt 60 ] && { sinfo; tail -n 5 "$dir/slurmctld.log" "$dir/slurmd.log"; exit 96; }
  sleep 0.5
done
"$@"
