//! Files of every layout that is read, written here from known samples as their publishers lay them out.

use rocking_records::{Column, Reading, Unit};
use std::fmt::Write;
use std::path::PathBuf;

/// Time between samples, s.
pub const DT: f64 = 0.005;

#[derive(Clone, Debug)]
pub struct LayoutCase {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
    pub how: Reading,
    pub format: &'static str,
    pub unit: Unit,
    /// Accelerations in that unit, rounded as they are written.
    pub expected: Vec<f64>,
}

/// A decaying sine, in cm/s² as the files of most archives, to five decimals.
pub fn samples(count: usize) -> Vec<f64> {
    let value = |i: usize| {
        let t = i as f64 * DT;
        (1e5 * 312.5 * (-t).exp() * (12.0 * t).sin()).round() / 1e5
    };
    (0..count).map(value).collect()
}

/// `values` in lines of `columns`.
fn lines(values: &[f64], columns: usize, write: impl Fn(f64) -> String) -> String {
    let lines = values.chunks(columns).map(|line| line.iter().map(|value| write(*value)).collect::<String>() + "\n");
    lines.collect()
}

/// Every layout, with `count` samples.
pub fn all(count: usize) -> Vec<LayoutCase> {
    let cm = samples(count);
    let layout = |name: &str, format, unit, text: String| LayoutCase {
        path: name.into(),
        bytes: text.into_bytes(),
        how: Reading::default(),
        format,
        unit,
        expected: cm.clone(),
    };
    let gal = Unit::CentimetrePerSecondSquared;
    let at2 = |title: &str, counts: &str| {
        let header =
            format!("{title}\nImperial Valley 5/19/1940, El Centro, 180\nACCELERATION TIME SERIES IN UNITS OF G\n");
        let text = header + counts + "\n" + &lines(&cm, 5, |value| format!("{value:15.7E}"));
        layout("record.AT2", "PEER AT2", Unit::G, text)
    };
    let (counts, expected) = knet(&cm);
    let mut all = vec![
        at2(
            "a line more\nPEER STRONG MOTION DATABASE RECORD. PROCESSING BY CHARLES MUELLER.",
            &format!("{count:5}    {DT:.4}    NPTS, DT"),
        ),
        at2("PEER NGA STRONG MOTION DATABASE RECORD", &format!("NPTS=  {count:4}, DT=   .0050 SEC,")),
        layout("record.ASC", "ESM and ITACA ASCII", gal, esm(&cm)),
        LayoutCase { expected, ..layout("MYG0041103111446.NS", "K-NET and KiK-net ASCII", gal, counts) },
        layout("record.V1", "COSMOS V1 and V2", gal, cosmos("Uncorrected acceleration", &cm, false)),
        layout("record.V2c", "COSMOS V1 and V2", gal, cosmos("Corrected acceleration", &cm, true)),
        layout("record.V2", "CSMIP V2", gal, csmip(&cm)),
    ];
    for (separator, comma, heading) in [
        (",", ".", "time (s),acc (cm/s2)"),
        (";", ",", "Zeit [s];Beschleunigung [cm/s^2]"),
        ("\t", ".", "t\tgal"),
        ("  ", ".", "time   acceleration_gal"),
        ("   ", ",", "# time   acceleration (gal)"),
        (" , ", ".", "\"time\",\"acc, cm/s/s\""),
    ] {
        let mut text = format!("{heading}\n");
        for (i, value) in cm.iter().enumerate() {
            let [time, value] = [i as f64 * DT, *value].map(|number| number.to_string().replace('.', comma));
            writeln!(text, "{time}{separator}{value}").unwrap();
        }
        all.push(layout("table.dat", "table", gal, text));
    }
    let column = cm.iter().map(|value| format!("{value}\n")).collect::<String>();
    let with_step = |unit| Reading { dt: Some(DT), unit, ..Reading::default() };
    let read_as = |how: Reading, layout: LayoutCase| LayoutCase { how, ..layout };
    all.push(read_as(with_step(Some(gal)), layout("column.txt", "table", gal, column)));
    let array = |(i, value): (usize, &f64)| format!("{},{},\"{value}\",{i}\r\n", i as f64 * DT, -2.0 * value);
    let array = "Time (s),N-S (gal),E-W (gal),n\r\n".to_owned() + &cm.iter().enumerate().map(array).collect::<String>();
    let chosen = Reading { column: Some(Column::Heading("E-W".into())), ..Reading::default() };
    all.push(read_as(chosen, layout("array.csv", "table", gal, array)));
    let seconds = |i: usize| format!("{:.3}", i as f64 * DT);
    let table = |heading: &str, time: fn(usize) -> String| {
        let line = |(i, value): (usize, &f64)| format!("{},{value}\n", time(i));
        let text = format!("{heading}\n") + &cm.iter().enumerate().map(line).collect::<String>();
        layout("table.csv", "table", gal, text)
    };
    let several = |before: &str, columns| {
        let text = before.to_owned() + &lines(&cm, columns, |value| format!(" {value:11.5}"));
        layout("values.out", "table", gal, text)
    };
    let of_three = |before: &str| {
        let row = |value: &f64| format!(" {},{value},{}\n", -2.0 * value, 0.5 * value);
        let text = before.to_owned() + &cm.iter().map(row).collect::<String>();
        let how = Reading { column: Some(Column::Number(2)), ..Reading::default() };
        read_as(how, layout("components.csv", "table", gal, text))
    };
    all.extend([
        layout("record.cor", "ESD ASCII", gal, esd(&cm)),
        layout("record.smc", "USGS SMC", gal, smc(&cm)),
        table("# peak in g: 0.3\nt/ms,a/gal", |i| (5 * i).to_string()),
        table("Time,Acceleration\n(sec),(cm/sec^2)", seconds),
        read_as(with_step(None), table("n,acc (gal)", |i| (i + 1).to_string())),
        read_as(Reading { column: Some(Column::All), ..with_step(Some(gal)) }, several("", 8)),
        several(&format!("ACCELERATION TIME HISTORY IN UNITS OF CM/SEC^2\nNPTS= {count}, DT= {DT} SEC\n"), 5),
        of_three("SITE CODE= 47401,45.4\r\n SAMPLING RATE= 200Hz,,\r\n UNIT  = gal(cm/s/s),,\r\n NS,EW,UD\r\n"),
        of_three(&format!(
            "SAMPLING INTERVAL (sec) : {DT}\nRAW PGA VALUES (gal) : (N-S) 625 (E-W) 312.5\nN-S    E-W    U-D\n"
        )),
        several(&format!("UNIT: CM/SEC/SEC\nNO. OF POINTS: {count}  EQUALLY SPACED INTERVALS OF:  {DT}  SEC\n\n"), 8),
        several(&format!("NPTS= {count} DT= 0,0050 ACC IN GAL\n"), 8),
        table("*TITLE, El Centro\n*X-AXIS, Time (sec)\n*Y-AXIS, Ground Accel. (gal)\n*FLAGS, 0, 0\n*DATA", seconds),
    ]);
    all
}

fn esm(values: &[f64]) -> String {
    let count = values.len();
    let header = format!(
        "EVENT_NAME: CENTRAL_ITALY\nEVENT_ID: EMSC-20160824_0000006\nEVENT_DATE_YYYYMMDD: 20160824\nMAGNITUDE_L: \n\
         STATION_CODE: AMT\nDATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: 20160824_013630.000\n\
         SAMPLING_INTERVAL_S: {DT:.6}\nNDATA: {count}\nDURATION_S: 2.0\nSTREAM: HGE\nUNITS: cm/s^2\n\
         PGA_CM/S^2: 312.5\nHEADER_FORMAT: DYNA 1.2\nDATA_TYPE: ACCELERATION\nUSER5: \n"
    );
    header + &lines(values, 1, |value| format!("{value:.6}"))
}

fn esd(values: &[f64]) -> String {
    let rows = lines(values, 6, |value| format!("{value:13.5}"));
    format!(
        "file:             001234xa.cor\nearthquake code:   12\nstation code:      34\nwaveform code:     1234\nsampling period: \
         {DT:.6}s\nnumber of samples: {}\nunits:             cm/s*s, cm/s & s\nreference:\nSomebody (2000)\ncomments: none\n\
         %- filtered\n-> corrected acceleration time histories\n{rows}-> corrected velocity time histories\n{rows}",
        values.len()
    )
}

fn smc(values: &[f64]) -> String {
    let mut text = "2 CORRECTED ACCELEROGRAM\n".to_owned() + &"*\n".repeat(10);
    let (mut integers, mut reals) = ([-32768.0; 48], [1.7e38; 50]);
    (integers[15], integers[16], reals[1]) = (1.0, values.len() as f64, 1.0 / DT);
    text += &lines(&integers, 8, |value| format!("{value:10}"));
    text += &lines(&reals, 5, |value| format!("{value:15.7E}"));
    text + "| one comment\n" + &lines(values, 8, |value| format!("{value:10.5}"))
}

/// Counts of a recorder that shows 8000 at rest, and the accelerations that they are.
fn knet(cm: &[f64]) -> (String, Vec<f64>) {
    const GAL: f64 = 3920.0 / 6182761.0;
    let counts: Vec<i64> = cm.iter().map(|value| 8000 + (value / GAL).round() as i64).collect();
    let mean = counts.iter().sum::<i64>() as f64 / counts.len() as f64;
    let expected: Vec<_> = counts.iter().map(|count| (*count as f64 - mean) * GAL).collect();
    let maximum = expected.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let header = format!(
        "Origin Time       2011/03/11 14:46:00\nLat.              38.103\nLong.             142.860\nDepth. (km)       24\n\
         Mag.              9.0\nStation Code      MYG004\nStation Lat.      38.7292\nStation Long.     141.0217\n\
         Station Height(m) 40\nRecord Time       2011/03/11 14:46:51\nSampling Freq(Hz) 200Hz\n\
         Duration Time(s)  {}\nDir.              N-S\nScale Factor      3920(gal)/6182761\nMax. Acc. (gal)   {maximum:.3}\n\
         Last Correction   2011/03/11 14:46:36\nMemo.             \n",
        counts.len() as f64 * DT
    );
    let values: Vec<_> = counts.iter().map(|count| *count as f64).collect();
    (header + &lines(&values, 8, |count| format!("{count:9}")), expected)
}

/// One channel; in volume 2 with its velocities and displacements.
pub fn cosmos(kind: &str, values: &[f64], is_volume_2: bool) -> String {
    let count = values.len();
    let mut text = format!(
        "{kind}    (Format v01.20 with 13 text lines) Src: 921az039.evt\nRcrd of Wed Jan 15, 2014 01:35:00.0 PST\n\
         Hypocenter: 34.143  -117.442   H=  5km(SCSN) M=4.4\nOrigin: 01/15/2014, 09:35:19.0 UTC\n\
         Statn No: 05- 13921 Code:CE-13921  CGS  Riverside - Limonite & Downey\nCoords: 33.975  -117.487\n\
         Recorder: Etna   s/n 1614 ( 3 Chns of   3 at Sta) Sensor: FBA\nRcrd start time: 1/15/2014, 09:35:23.2 UTC\n\
         Sta Chan  1: 360 deg (Rcrdr Chan  1) Location:\nRaw record length =  56.000 sec\nProcessed: 01/15/14\n\
         Record not filtered.\nValues used when parameter or data value is unknown/unspecified:   -999, -999.0\n"
    );
    text += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n";
    text += &lines(&[-999.0; 100], 10, |value| format!("{value:8}"));
    text += " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n";
    let mut reals = [-999.0; 100];
    (reals[33], reals[61]) = (0.01, 1e3 * DT); // as recorded, and resampled for this series
    reals[34] = 426212.0; // fills its column
    text += &lines(&reals, 6, |value| format!("{value:13.6}"));
    text += "   1 Comment line(s) follow, each starting with a \"|\":\n| pts units=none acc\n";
    let what = if is_volume_2 { "acceleration pts" } else { "uncor. accel. pts" };
    writeln!(text, "{count:8} {what}, approx   2 secs, units=cm/sec2(04),Format=(8F10.5)").unwrap();
    let columns = lines(values, 8, |value| format!("{value:10.5}"));
    text += &columns;
    if is_volume_2 {
        for (what, unit) in [("velocity    ", "cm/s  (05)"), ("displacement", "cm    (06)")] {
            let before = format!("{count:8} {what} pts, approx   2 secs, units={unit},Format=(8F10.5)\n");
            text += &(before + &columns);
        }
    }
    text + "End-of-data for Chan  1 acceleration\n"
}

fn csmip(values: &[f64]) -> String {
    let count = values.len();
    let mut text = "Corrected accelerogram   58667-L2866-14236.52       Chan  1:  H1         from   \n".to_owned();
    for line in 2..26 {
        writeln!(text, "line {line} of the text header, 1.0 2.0").unwrap();
    }
    text += &lines(&[100.0; 100], 16, |value| format!("{value:5}"));
    text += &lines(&[-999.0; 100], 8, |value| format!("{value:10.5}"));
    for what in ["accel", "veloc", "displ"] {
        writeln!(text, "{count:6} points of {what} data equally spaced at  .005 sec, in cm/sec2. (8f10.5)    ")
            .unwrap();
        text += &lines(values, 8, |value| format!("{value:10.5}"));
    }
    text + "/&  ----------  End of data for channel  1  ----------\n"
}
