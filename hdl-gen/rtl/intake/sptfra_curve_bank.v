// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Curve from counts to pascals in two calibration banks. Words of a bank from FIRST on:
//
//     4 of each segment  number with which it begins, value there, slope, bits dropped behind the slope
//     1                  count of segments; what stands in those behind it means nothing
//     2                  number with which the last one ends, value there
//
// Words that are out of bounds are not written. A commit checks what depends on several words, a segment in the
// cycles of four words. Numbers ascend, and values only rise or only fall. Each slope leads from its value to the
// next one's, within 2^-16 of the way and a step. So no value leaves its format.

`default_nettype none

module sptfra_curve_bank #(
    // Room for 2^LEVELS segments
    parameter LEVELS = 4,
    // Word of a bank with which this part of it begins
    parameter [15:0] FIRST = 16'd26,
    // At power-up: segments, and the numbers with which they begin; values, slopes and shifts stand in files
    parameter [6:0] COUNT = 7'd1,
    parameter [27*(1<<LEVELS)-1:0] KNOTS = {27*(1<<LEVELS){1'b0}},
    // At power-up: number with which the last segment ends, and the value there
    parameter signed [26:0] LAST = 27'sd33554431,
    parameter signed [26:0] LAST_VALUE = 27'sd0,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter SEGMENTS = 1 << LEVELS
) (
    input  wire clock,
    input  wire [55:0] command, // as of sptfra_dead_bank
    output wire [33:0] result,
    // While a tare listens, the active bank's curve is copied into the other one
    input  wire active,
    input  wire tare_run,
    output wire copying,
    // Of both banks, that of bank 1 in the higher bits
    output wire [2*27*SEGMENTS-1:0] knots,
    output wire [13:0] counts,
    output wire [53:0] lasts,
    output wire [53:0] reaches, // magnitude from which on a number is at an end
    // The line of a segment: number with which it begins, value there, slope, bits dropped
    input  wire read_bank,
    input  wire [LEVELS-1:0] read_segment,
    output wire [77:0] read_line
);

    localparam [31:0] SEGMENT_WORDS_WIDE = 4 * SEGMENTS;
    localparam [15:0] SEGMENT_WORDS = SEGMENT_WORDS_WIDE[15:0];
    localparam [31:0] ROOM_WIDE = SEGMENTS;
    localparam signed [31:0] MOST_NUMBER = 32'sd33554431;
    localparam signed [31:0] MOST_VALUE = 32'sd67104767; // and what a slope may add at a segment's end
    localparam signed [31:0] MOST_SLOPE = 32'sd131071;
    localparam [31:0] MOST_SHIFT = 32'd40;
    localparam HEAD_BITS = 7 + 2 * 27;
    localparam [HEAD_BITS-1:0] HEAD = {LAST_VALUE, LAST, COUNT};

    wire walk_begins = command[51];
    wire walk_takes = command[50];
    wire write = command[49];
    wire bank = command[48];
    wire [15:0] position = command[47:32];
    wire [31:0] data = command[31:0];

    // ---- The word: its place, then its content
    wire [15:0] place = position - FIRST;
    wire of_segment = (place < SEGMENT_WORDS);
    wire of_count = (place == SEGMENT_WORDS);
    wire of_last = (place == SEGMENT_WORDS + 16'd1);
    wire of_end = (place == SEGMENT_WORDS + 16'd2);
    wire [1:0] kind = place[1:0];
    wire [LEVELS-1:0] segment = place[LEVELS+1:2];
    reg [27*SEGMENTS-1:0] knots_0;
    reg [27*SEGMENTS-1:0] knots_1;
    reg [HEAD_BITS-1:0] head_0;
    reg [HEAD_BITS-1:0] head_1;
    wire [HEAD_BITS-1:0] head = bank ? head_1 : head_0;
    wire [77:0] line; // of the segment
    wire signed [26:0] first = line[77:51];
    wire signed [26:0] value = line[50:24];
    wire signed [17:0] slope = line[23:6];
    wire [5:0] shift = line[5:0];
    reg of_segment_1;
    reg [1:0] kind_1;
    reg [31:0] head_word_1;
    wire [31:0] segment_word = (kind_1 == 2'd0) ? {{5{first[26]}}, first} : (kind_1 == 2'd1) ? {{5{value[26]}}, value}
        : (kind_1 == 2'd2) ? {{14{slope[17]}}, slope} : {26'd0, shift};

    always @(posedge clock) begin
        of_segment_1 <= of_segment;
        kind_1 <= kind;
        head_word_1 <= of_count ? {25'd0, head[6:0]} : of_last ? {{5{head[33]}}, head[33:7]}
            : {{5{head[60]}}, head[60:34]};
    end

    // ---- Bounds
    wire number_fits = ($signed(data) <= MOST_NUMBER) && ($signed(data) >= -MOST_NUMBER);
    wire value_fits = ($signed(data) <= MOST_VALUE) && ($signed(data) >= -MOST_VALUE);
    wire slope_fits = ($signed(data) <= MOST_SLOPE) && ($signed(data) >= -MOST_SLOPE);
    wire shift_fits = (data != 32'd0) && (data <= MOST_SHIFT);
    wire count_fits = (data != 32'd0) && (data <= ROOM_WIDE);
    wire segment_fits = (kind == 2'd0) ? number_fits : (kind == 2'd1) ? value_fits
        : (kind == 2'd2) ? slope_fits : shift_fits;
    wire allowed = (of_segment && segment_fits) || (of_count && count_fits) || (of_last && number_fits)
        || (of_end && value_fits);
    wire writes = write && allowed;

    // ---- A tare's copy: a segment in two cycles
    reg copies;
    reg copy_writes;
    reg [LEVELS-1:0] copy_segment;
    reg tare_ran;
    wire copy_ends = copy_writes && (copy_segment == {LEVELS{1'b1}});
    wire [LEVELS:0] address = copies ? {active ^ copy_writes, copy_segment} : {bank, segment};

    assign copying = tare_run && (!tare_ran || copies);

    always @(posedge clock) begin
        tare_ran <= tare_run;
        copy_writes <= copies && !copy_writes && tare_run;
        if (copy_writes) begin
            copy_segment <= copy_segment + 1'b1;
        end
        if (copy_ends || !tare_run) begin
            copies <= 1'b0;
        end else if (!tare_ran) begin
            copies <= 1'b1;
            copy_segment <= {LEVELS{1'b0}};
        end
    end

    // ---- Banks; configuration, no reset, brings the design's content
    initial begin
        knots_0 = KNOTS;
        knots_1 = KNOTS;
        head_0 = HEAD;
        head_1 = HEAD;
        copies = 1'b0;
        copy_writes = 1'b0;
        tare_ran = 1'b0;
    end

    wire write_knot = copy_writes || (writes && of_segment && (kind == 2'd0));
    wire [26:0] knot_in = copy_writes ? first : data[26:0];
    wire [HEAD_BITS-1:0] head_in = copy_ends ? (active ? head_1 : head_0)
        : of_count ? {head[HEAD_BITS-1:7], data[6:0]} : of_last ? {head[60:34], data[26:0], head[6:0]}
        : {data[26:0], head[33:0]};
    wire write_head = copy_ends || (writes && !of_segment);
    wire to_bank = copies ? !active : bank;

    always @(posedge clock) begin
        if (write_knot && !to_bank) begin
            knots_0[27*address[LEVELS-1:0] +: 27] <= knot_in;
        end
        if (write_knot && to_bank) begin
            knots_1[27*address[LEVELS-1:0] +: 27] <= knot_in;
        end
        if (write_head && !to_bank) begin
            head_0 <= head_in;
        end
        if (write_head && to_bank) begin
            head_1 <= head_in;
        end
    end

    genvar index;

    for (index = 0; index < 4; index = index + 1) begin : gen_fields
        localparam WIDTH = (index < 2) ? 27 : (index == 2) ? 18 : 6;
        localparam PLACE = (index == 0) ? 51 : (index == 1) ? 24 : (index == 2) ? 6 : 0; // in a line
        localparam [8*6-1:0] NAME = (index == 0) ? "firsts" : (index == 1) ? "values"
            : (index == 2) ? "slopes" : "shifts";

        sptfra_bank #(
            .WIDTH         (WIDTH),
            .ADDRESS_WIDTH (LEVELS + 1),
            .ROM_DIR       (ROM_DIR),
            .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_curve_", NAME, ".mem"})
        ) field (
            .clock        (clock),
            .write_enable (copy_writes || (writes && of_segment && (kind == index))),
            .address      (address),
            .write_data   (copy_writes ? line[PLACE +: WIDTH] : data[WIDTH-1:0]),
            .data         (line[PLACE +: WIDTH]),
            .read_address ({read_bank, read_segment}),
            .read_data    (read_line[PLACE +: WIDTH])
        );
    end

    // ---- The walk of a commit: with a segment's last word its check begins
    wire [27*SEGMENTS-1:0] knots_here = bank ? knots_1 : knots_0;
    wire [LEVELS-1:0] segment_next = segment + 1'b1;
    wire [6:0] number_next = {{(7-LEVELS){1'b0}}, segment} + 7'd1;
    wire is_last = (number_next == head[6:0]);
    wire signed [26:0] first_next = is_last ? $signed(head[33:7]) : $signed(knots_here[27*segment_next +: 27]);
    wire signed [27:0] along = {first_next[26], first_next} - {first[26], first};
    wire begins = walk_takes && of_segment && (kind == 2'd3) && (number_next <= head[6:0]);

    // ---- Its check: it multiplies by two bits of the slope a cycle. From begins to contradicts: 17 cycles; the next
    // segment's value is taken in the 12th
    localparam [4:0] SHIFTS = 5'd10, ROUNDS = 5'd11, AIMS = 5'd14, MISSES = 5'd15, JUDGES = 5'd16, ENDS = 5'd17;

    reg [4:0] step; // 0: none under way
    reg [17:0] multiplier;
    reg [45:0] multiplicand;
    reg [45:0] product;
    reg [5:0] shift_held;
    reg negative;
    reg ends_curve;
    reg signed [26:0] begin_value;
    reg signed [26:0] taken;
    reg signed [46:0] rise;
    reg signed [27:0] way;
    reg signed [47:0] missed;
    reg [27:0] tolerance;
    reg rises;
    reg falls;
    reg contradicts;
    wire [46:0] rounded = {1'b0, product} + 47'd1;
    wire signed [46:0] half = {1'b0, rounded[46:1]};
    wire [27:0] distance = way[27] ? -way : way;
    wire signed [47:0] most_missed = {20'd0, tolerance};

    always @(posedge clock) begin
        step <= ((step == 5'd0) || (step == ENDS)) ? 5'd0 : step + 5'd1;
        if (walk_takes && of_segment && (kind == 2'd1)) begin // the value of the next segment
            taken <= value;
        end
        multiplier <= multiplier >> 2;
        multiplicand <= multiplicand << 2;
        if (step < SHIFTS) begin
            product <= product + (multiplier[0] ? multiplicand : 46'd0)
                + (multiplier[1] ? {multiplicand[44:0], 1'b0} : 46'd0);
        end
        if (step == SHIFTS) begin
            product <= product >> (shift_held - 6'd1);
        end
        if (step == ROUNDS) begin
            rise <= negative ? -half : half;
        end
        if (step == AIMS) begin
            way <= (ends_curve ? {head[60], head[60:34]} : {taken[26], taken}) - {begin_value[26], begin_value};
        end
        if (step == MISSES) begin
            missed <= {rise[46], rise} - {{20{way[27]}}, way};
            tolerance <= (distance >> 16) + 28'd1;
            rises <= rises || (way > 28'sd0);
            falls <= falls || way[27];
        end
        if (step == JUDGES) begin
            contradicts <= contradicts || (missed > most_missed) || (missed < -most_missed) || (rises && falls);
        end
        if (begins) begin
            step <= 5'd1;
            multiplier <= slope[17] ? -slope : slope;
            multiplicand <= {18'd0, along};
            product <= 46'd0;
            shift_held <= shift;
            negative <= slope[17];
            ends_curve <= is_last;
            begin_value <= value;
            contradicts <= contradicts || (along <= 28'sd0);
        end
        if (walk_begins) begin
            step <= 5'd0;
            contradicts <= 1'b0;
            rises <= 1'b0;
            falls <= 1'b0;
        end
    end

    // ---- Frames
    function [26:0] reach_of(input signed [26:0] from, input signed [26:0] to);
        reg [26:0] low;
        reg [26:0] high;
        begin
            low = from[26] ? -from : from;
            high = to[26] ? -to : to;
            reach_of = (low > high) ? low : high;
        end
    endfunction

    assign result = {contradicts, allowed, of_segment_1 ? segment_word : head_word_1};
    assign knots = {knots_1, knots_0};
    assign counts = {head_1[6:0], head_0[6:0]};
    assign lasts = {head_1[33:7], head_0[33:7]};
    assign reaches = {reach_of(knots_1[26:0], head_1[33:7]), reach_of(knots_0[26:0], head_0[33:7])};

    wire _unused = &{1'b0, command[55:52], rounded[0]};

endmodule

`default_nettype wire
